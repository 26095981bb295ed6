"""APT CL text (ISO 4343): its statements, its modal state, and the motions it makes."""
