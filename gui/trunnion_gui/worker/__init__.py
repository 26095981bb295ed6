"""The process that computes: its requests and replies, its verbs, and what it sends to be drawn."""
