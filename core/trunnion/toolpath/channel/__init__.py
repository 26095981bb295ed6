"""Strategies in the channels of bladed wheels, a module a strategy."""
