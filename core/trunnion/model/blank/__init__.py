"""The blank: the material that the first setup starts from, of whatever kind."""

from trunnion.model.blank.base import Builder as Builder
from trunnion.model.blank.box import Box as Box
from trunnion.model.blank.mesh import Faceted as Faceted
from trunnion.model.blank.revolved import AXES as AXES
from trunnion.model.blank.revolved import Revolved as Revolved

Blank = Box | Revolved | Faceted
