"""The proof of turning: work that turns about an axis, seen in the plane through it."""
