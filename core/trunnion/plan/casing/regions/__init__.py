"""Which regions of a casing's bottoms are turned, turned with interruptions, or milled."""
