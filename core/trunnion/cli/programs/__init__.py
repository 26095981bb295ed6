"""The commands of programs: written, proven, posted again, many parts at once."""
