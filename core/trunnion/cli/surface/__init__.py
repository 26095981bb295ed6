"""Commands of the family of curved surfaces."""
