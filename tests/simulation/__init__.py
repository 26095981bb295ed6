"""A simulation of its own that judges the text of a program as a machine would run it.

It reads the G code, the tool list and the process tree that were written, and the part file that a shop was sent. It knows nothing of how
a program was planned or proven, and imports nothing of the program that wrote it: a fault that planner and proof share would show here.

Three axes, one setup: material stands in columns along the setup's z, each cut down by the cutter's true bottom form over the whole sweep
of every move. The columns stand on a lattice that is turned against the part, so that no wall runs along its rows.
"""
