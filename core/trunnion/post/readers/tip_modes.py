"""What codes do on a control that follows the tip and tilts its plane, whatever it calls them."""

from __future__ import annotations

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.model.setup import Setup
from trunnion.post.readers.directions import Directions
from trunnion.post.readers.sections import Sections, UprightPoses
from trunnion.post.readers.tilted_sections import TiltedSections, TipPoses
from trunnion.post.readers.tip_moves import TipMover
from trunnion.post.readers.word_address.blocks import Block
from trunnion.post.readers.word_address.interpreter import Control
from trunnion.post.readers.word_address.modes import Modes
from trunnion.post.readers.word_address.rotary import Rotary


class TipModes(Modes):
    """Follows the tip and tilts the plane of the program; the codes that do so are a derived class's."""

    def follow(self, block: Block, code: str) -> None:
        """Follow the tip from here on: points are tips in the work, directions are vectors."""
        self.tilted(block, code).follow(block.line, code, self.language.words.no_plane)

    def leave_tip(self, block: Block) -> None:
        """Follow the tip no longer; where the rotary axes stand is not in the text."""
        sections = self.state.sections
        if isinstance(sections, TiltedSections):
            sections.follows = False

    def tilt(self, block: Block, code: str, matrix: Floats, side: int = 0) -> None:
        """Tilt the plane of the program to axes (3, 3), columns in the setup frame, and turn the tool along its z, to the side named by
        the text (`Stance`): at the top of the machine, unless it points there."""
        sections, top = self.tilted(block, code), self.language.words.top
        sections.turn_to(block.line, code, matrix, top, side)

    def level(self, block: Block, code: str) -> None:
        """Take the plane of the setup again; the tool points where it did."""
        self.tilted(block, code).level_out()

    def tilted(self, block: Block, code: str) -> TiltedSections:
        """Return the sections of a machine with rotary axes; raise `BadInput` for a machine without."""
        if not isinstance(self.state.sections, TiltedSections):
            raise BadInput(
                f"line {block.line}: {code} on {self.state.setup.machine}, a machine without rotary axes; remove it"
            )
        return self.state.sections

    def refuse_following(self, block: Block, code: str) -> None:
        """Raise `BadInput` for a plane while the control follows the tip."""
        sections, words = self.tilted(block, code), self.language.words
        if sections.follows:
            begins = self.begins
            raise BadInput(
                f"line {block.line}: {code} under {begins} is not understood; put {words.no_tip_control} first"
            )

    @property
    def begins(self) -> str:
        """The code by which the control follows the tip."""
        return next((c for c, m in self.language.meanings.items() if m == "tip control"), "")


class TipControl(Control):
    """A control that follows the tip on machines with rotary axes."""

    mover_class = TipMover

    def sections_of(self, setup: Setup) -> Sections:
        """Return what gathers the motions: tips, on a machine with rotary axes with the tool's direction."""
        if self.work_position is None:
            return Sections(UprightPoses(setup.clearance))
        return TiltedSections(TipPoses(self.work_position, setup.clearance))

    def rotary_axes(self) -> Rotary:
        """Return what keeps the tool's direction."""
        sections = self.state.sections
        if isinstance(sections, TiltedSections):
            return Directions(sections, self.language)
        return Rotary("", self.language.inverse)
