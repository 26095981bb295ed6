"""Views of the session around the picture; docks do not import each other."""
