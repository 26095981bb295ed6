"""What the steps up to the toolpaths are made of: family, blank, scene, clearance, edits by hand."""
