"""How far apart passes lie for a scallop height, in planes and over faces."""
