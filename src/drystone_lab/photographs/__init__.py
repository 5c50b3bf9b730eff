"""Rendered photographs of stones laid out, with the truth about them."""
