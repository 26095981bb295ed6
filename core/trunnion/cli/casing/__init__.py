"""Commands for casings."""
