"""Turning: what an insert in its holder reaches of a body of revolution, and the drive geometry of turning operations."""
