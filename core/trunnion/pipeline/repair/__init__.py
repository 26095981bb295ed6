"""Repair of a plan that failed its proof: fixes that findings ask for, tried round by round, kept when the proof says it is better."""
