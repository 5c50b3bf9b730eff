"""Which blocks there are and where they touch: from pixels, outlines, block models (§4.2)."""
