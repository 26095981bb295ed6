"""Reads Klartext, Heidenhain's conversational format."""
