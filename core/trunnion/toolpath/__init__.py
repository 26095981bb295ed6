"""From drive geometry to motions: strategies, and what they share (links, leads, entries, feeds, time)."""
