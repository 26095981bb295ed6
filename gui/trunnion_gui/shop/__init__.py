"""The window of the shop: tools with the tool crib, machines, materials."""
