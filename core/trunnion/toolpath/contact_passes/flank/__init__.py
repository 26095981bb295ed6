"""Passes of a flank along guide lines, and the stock beside them."""
