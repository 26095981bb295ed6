"""Planning of casings: which regions of a pocket's bottom are turned, turned with interruptions, or milled, and what cutters leave."""
