"""The machine: axis positions, time of the blocks, limits."""
