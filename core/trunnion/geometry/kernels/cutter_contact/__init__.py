"""Where a cutter touches triangles: dropped along its axis, pushed across it."""
