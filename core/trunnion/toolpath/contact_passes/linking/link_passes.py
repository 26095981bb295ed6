"""From passes to a toolpath: in which order they are cut, how the cutter comes to each and leaves it, and the links between.

A pass that begins near the end of the one before is reached over the surface; else the cutter is lifted as far as the stock demands.
Whatever is not a cut is lifted where it would come below the dropped cutter.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from trunnion.geometry.arrays import Bools, Floats
from trunnion.model.motion.toolpath import EMPTY, Mark, Toolpath
from trunnion.model.operation import CuttingData
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.plan.freeform.drive import SurfaceDrive
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.toolpath.contact_passes.extension import extended
from trunnion.toolpath.contact_passes.linking.blocks import Blocks
from trunnion.toolpath.contact_passes.linking.leads import Leads, leads_of
from trunnion.toolpath.contact_passes.linking.leaning_links import LeaningLinks, Link, LinkMoves
from trunnion.toolpath.contact_passes.linking.parameters import LinkParameters
from trunnion.toolpath.contact_passes.linking.pass_order import ordered
from trunnion.toolpath.contact_passes.linking.surface_links import (
    free_of_stock,
    is_over,
    near_passes,
    surface_links,
)
from trunnion.toolpath.contact_passes.passes import Pass
from trunnion.toolpath.stock.heightfield import PlanningStock


def linked(
    passes: Sequence[Pass],
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    parameters: LinkParameters,
    progress: Progress = NO_PROGRESS,
) -> Toolpath:
    """Return the toolpath that cuts all passes, in the cutting frame; it begins and ends at the setup's clearance height."""
    passes = extended_in_order(passes, drive, tool, parameters, progress.part(0.0, 0.2))
    return linked_in_order(
        passes, drive, tool, data, stock, setup, parameters, progress.part(0.2, 1.0)
    )


def extended_in_order(
    passes: Sequence[Pass],
    drive: SurfaceDrive,
    tool: Tool,
    parameters: LinkParameters,
    progress: Progress = NO_PROGRESS,
) -> list[Pass]:
    """Return the passes run on past free rims, in the order that they are cut."""
    whole = extended([p for p in passes if len(p) > 1], drive, tool, parameters.query)
    return ordered(whole, parameters, progress) if whole else []


def linked_in_order(
    passes: Sequence[Pass],
    drive: SurfaceDrive,
    tool: Tool,
    data: CuttingData,
    stock: PlanningStock,
    setup: Setup,
    parameters: LinkParameters,
    progress: Progress = NO_PROGRESS,
) -> Toolpath:
    """Return the toolpath that cuts passes as they are and in this order, without running them on (`linked`)."""
    if not passes:
        return EMPTY
    # Leads and links of all passes at once: drops on the skin are cheap only in batches.
    leads = leads_of(passes, drive, tool, parameters, progress.part(0.0, 0.25))
    links = _surface_links(passes, leads, drive, tool, parameters, progress.part(0.25, 0.75))
    leaning = LeaningLinks.of(passes, leads)
    links |= leaning.near(tool, parameters)
    far = np.ones(len(passes) - 1, dtype=bool)
    far[list(links)] = False
    approach, retract = _retreats(passes, far, leads, parameters, progress)
    links |= leaning.through_air(
        np.flatnonzero(far), retract[:-1], approach[1:], parameters, progress.part(0.75, 0.9)
    )
    # Assemble: where passes have no link, by their leads and a travel over everything.
    blocks = Blocks(tool, data, stock, setup, drive, parameters)
    for k, one in enumerate(passes):
        progress.at(0.9 + 0.1 * k / len(passes), "Linking passes")
        if k - 1 in links:
            blocks.follow(links[k - 1])
        else:
            if k:
                blocks.feed(leads.off(k - 1), passes[k - 1].axis[-1], Mark.LEAD)
            blocks.travel(
                leads.lead_in[k, 0],
                one.axis[0],
                float(retract[k - 1]) if k else 0.0,
                float(approach[k]),
            )
            blocks.feed(np.vstack([leads.onto(k)[1:], one.tip[:1]]), one.axis[0], Mark.LEAD)
        blocks.feed(one.tip, one.axis, Mark.CUT)
    blocks.feed(leads.off(len(passes) - 1), passes[-1].axis[-1], Mark.LEAD)
    return blocks.finished(float(retract[-1]))


def _surface_links(
    passes: Sequence[Pass],
    leads: Leads,
    drive: SurfaceDrive,
    tool: Tool,
    parameters: LinkParameters,
    progress: Progress,
) -> dict[int, Link]:
    """Return the links, by the number of the pass before, that stay over the surface while the tool keeps its axis."""
    near = near_passes(passes, parameters)
    if parameters.arcs:
        near &= leads.has_links
        chords = [
            np.array([leads.lead_out[k, -1], leads.lead_in[k + 1, 0]])
            for k in np.flatnonzero(near).tolist()
        ]
        near[near] = is_over(chords, drive, tool, parameters, progress)
        tips = [
            np.vstack([leads.off(k), leads.onto(k + 1), passes[k + 1].tip[:1]])
            for k in np.flatnonzero(near).tolist()
        ]
    else:
        tips = surface_links(passes, near, drive, tool, parameters, progress)
    rows = np.flatnonzero(near).tolist()
    whole = [np.vstack([passes[k].tip[-1:], w]) for k, w in zip(rows, tips, strict=True)]
    is_free = free_of_stock(
        whole, [passes[k + 1].axis[0] for k in rows], [k + 1 for k in rows], parameters
    )
    return {
        k: (LinkMoves(tip=w, axis=np.broadcast_to(passes[k + 1].axis[0], w.shape), mark=Mark.LINK),)
        for k, w, free in zip(rows, tips, is_free, strict=True)
        if free
    }


def _retreats(
    passes: Sequence[Pass], far: Bools, leads: Leads, parameters: LinkParameters, progress: Progress
) -> tuple[Floats, Floats]:
    """Return how far (m,) in mm a tool comes at feed along its axis to the lead of each pass, and goes off after it; 0 where links join
    them."""
    approach, retract = np.zeros(len(passes)), np.zeros(len(passes))
    if parameters.link_clearance is not None:
        progress.at(0.8, "Linking passes")
        begun, left = (np.flatnonzero(np.insert(far, at, True)) for at in (0, len(passes) - 1))
        for found, rows, lead, end, of_pass in (
            (approach, begun, leads.lead_in, 0, 0),
            (retract, left, leads.lead_out, -1, -1),
        ):
            axes = np.array([passes[k].axis[of_pass] for k in rows.tolist()])
            found[rows] = parameters.link_clearance.retreats(lead[rows, end], axes)
    if parameters.pass_stock is not None:
        # Flutes that came from the side, under stock that the neck went by, would go up through it.
        left = np.append(np.flatnonzero(far), len(passes) - 1)
        tips = leads.lead_out[left, -1]
        over = parameters.pass_stock.tops(tips, left + 1) - tips[:, 2]
        retract[left] = np.maximum(retract[left], over)
    return approach, retract
