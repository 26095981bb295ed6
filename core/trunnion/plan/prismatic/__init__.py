"""What planners share for vertical walls and level floors: plan regions by features, and plane drives."""
