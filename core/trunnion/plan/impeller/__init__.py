"""Plans of impellers."""
