"""Cutting data: speeds and feeds, power and torque, and the peak load of an operation."""
