"""Plans of the library: taught by a finished process, and followed by the route of a similar part."""
