"""What the steps after the toolpaths are made of: programs posted, read back and proven; stock over time."""
