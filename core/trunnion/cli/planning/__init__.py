"""The commands of planning, a step each: from features to cutting data."""
