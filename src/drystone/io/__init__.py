"""Readers of stones: label images, masks, folders of masks and arrays become a StoneSet."""
