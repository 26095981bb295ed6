"""Clearing at constant engagement: passes that keep the angle of contact, laid one after another over what the ones before cleared."""
