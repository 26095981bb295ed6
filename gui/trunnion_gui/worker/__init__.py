"""The process that computes: its requests and replies, what it can be asked for, and what it sends to be drawn."""
