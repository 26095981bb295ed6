"""What surface strategies share: contacts, tool axes, passes, their spacing and linking."""
