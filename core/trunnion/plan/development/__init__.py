"""Planning over the development of turned ground: what stands on it, and plane drives over it."""
