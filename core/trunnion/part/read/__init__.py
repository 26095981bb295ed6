"""From a part file to a `Part`: a process with limits, the CAD kernel's readers, healing, fixtures."""
