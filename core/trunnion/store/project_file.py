"""The ending of a project file's name."""

PROJECT_SUFFIX = ".trunnion"
