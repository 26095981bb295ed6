"""What planners share for curved faces: skins seen from a direction, reach, rest, scallops, lands, layers, directions of approach."""
