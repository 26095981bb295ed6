"""Repair: what planners do with the fixes that findings ask for, each kind a registered function from process to process."""
