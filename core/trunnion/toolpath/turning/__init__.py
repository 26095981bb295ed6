"""Strategies of turning: the work turns, an insert goes along its meridian."""
