"""What is left on the part: the nearest that the flutes come to it, coverage, and the fine look at scallops and steps."""
