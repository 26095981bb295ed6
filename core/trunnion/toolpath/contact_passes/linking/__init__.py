"""From passes to toolpaths: their order, how the cutter comes to each and leaves it, and the links between."""
