"""Programming a part from Python: what `import trunnion` gives to scripts, and what commands share with them."""
