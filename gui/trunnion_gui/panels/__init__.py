"""The six panels in the order of the work; panels do not import each other."""
