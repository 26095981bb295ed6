"""A control in word-address format (ISO 6983, RS274): its text, its modal state, and the motions it makes."""
