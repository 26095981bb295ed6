"""Curved surfaces: `view` is what the window gets; `requests` and `groups` know no Qt, for the worker."""
