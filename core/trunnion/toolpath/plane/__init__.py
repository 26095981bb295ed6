"""Strategies for plane machining (2.5 axes), independent of one another."""
