"""Random parts by seed, for figures over parts that nobody tuned for: the same seed gives the same part."""
