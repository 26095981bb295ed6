"""What a person changes of a process, operation by operation, and what of that a new route keeps."""
