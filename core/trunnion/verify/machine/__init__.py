"""What the machine does: where its axes stand, how long the blocks take, which limits they pass."""
