"""Rigid blocks from pixels, and the lateral load that they carry (§4)."""
