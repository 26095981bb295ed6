"""Plans for complex curved surfaces: variable parameters for local features and the rest."""
