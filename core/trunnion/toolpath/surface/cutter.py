"""A cutter as surface strategies see it; planning asks the same when it chooses cutters (`plan.surface.cutter`)."""

from trunnion.plan.surface.cutter import SURFACE_FORMS as SURFACE_FORMS
from trunnion.plan.surface.cutter import lower_side as lower_side
from trunnion.plan.surface.cutter import tip_at as tip_at
from trunnion.plan.surface.cutter import touching as touching
