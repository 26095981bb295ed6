"""What a path takes off the stock piece by piece: its load, and feeds that follow it."""
