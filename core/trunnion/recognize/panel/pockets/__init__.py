"""Generalized pockets from the face graph: blends, rings of walls, tops, and the rules."""
