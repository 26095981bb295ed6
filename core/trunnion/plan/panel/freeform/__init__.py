"""Pockets with leaning walls or curved floors: their areas, and the operations that clear and finish them."""
