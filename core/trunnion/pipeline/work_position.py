"""Where the work of each setup stands on its machine: what posts and readers need where rotary axes turn."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from trunnion.model.blank import Blank
from trunnion.model.material import Machine
from trunnion.model.session import Session
from trunnion.model.setup import Setup
from trunnion.plan.setups import held
from trunnion.shop.kinematics import WorkPosition, WorkPositions
from trunnion.toolpath.motion.reorient import clearance_sphere


def work_positions_of(session: Session, machines: Mapping[str, Machine]) -> WorkPositions:
    """Return where the work of every setup stands; setups on machines that the catalogue doesn't know are left out."""
    if session.blank is None:
        return {}
    setups = (held(s, session.fixtures_of(s.name), session.blank) for s in session.setups)
    return {
        s.name: work_position_of(s.begins_with(session.blank), s, machines[s.machine])
        for s in setups
        if s.machine in machines
    }


def work_position_of(blank: Blank, setup: Setup, machine: Machine) -> WorkPosition:
    """Return where a setup's work stands: the middle of the blank's underside lies on the middle of the table."""
    low, high = blank.box_in(setup.frame)
    sphere = clearance_sphere(blank, setup)
    foot = np.array([*(0.5 * (low + high))[:2], low[2]])
    return WorkPosition(machine=machine, foot=foot, centre=sphere.centre, radius=sphere.radius)
