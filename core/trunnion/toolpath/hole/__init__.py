"""Strategies for holes: drilling, helical milling, countersinking."""
