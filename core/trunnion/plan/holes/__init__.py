"""Planning of holes: their geometry in a setup, what drives their operations, and which tools fit."""
