"""The planner's stock: what is certainly gone, as height fields seen from each tool direction."""
