"""The one door that window, command line and scripts go through: `Session` in, `Session` out."""

from trunnion.pipeline.engine import Engine
from trunnion.pipeline.steps import STEPS

__all__ = ["STEPS", "Engine"]
