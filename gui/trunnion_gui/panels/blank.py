"""Panel 3: the blank with its allowances, volume and mass."""

from __future__ import annotations

from trunnion_gui.look.words import amount
from trunnion_gui.widgets.panel import Panel


class BlankPanel(Panel):
    """Allowances and what they make."""

    command = "step.blank"

    def fill(self) -> None:
        blank = self.document.shown.blank
        if blank is None:
            self.result.setText("")
            return
        size = " × ".join(sign + amount(v, 1) for sign, v in blank.measures())
        self.result.setText(
            f"{size} mm<br>{amount(blank.volume / 1e6, 2)} dm³ · {amount(blank.mass, 2)} kg {blank.material}"
        )
