"""Cylinders that curves of a STEP file draw, as threads are drawn about holes."""

from __future__ import annotations

import numpy as np
import pytest

from trunnion.part.read.step_curves import DrawnThread, cylinders_in

CURVES = """
#1=(CONVERSION_BASED_UNIT('INCH',#2) LENGTH_UNIT() NAMED_UNIT(#9));
#2=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#3);
#3=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));
#4=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNIT_ASSIGNED_CONTEXT((#5,#3)) REPRESENTATION_CONTEXT('',''));
#5=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));
#6=CONSTRUCTIVE_GEOMETRY_REPRESENTATION('supplemental geometry',(#10),#4);
#7=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#8,#6,#10);
#10=GEOMETRIC_CURVE_SET('Thread Cylinder.1',(#11,#12));
#11=TRIMMED_CURVE('',#13,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(4.7)),.T.,.PARAMETER.);
#12=TRIMMED_CURVE('',#14,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(5.)),.T.,.PARAMETER.);
#13=CIRCLE('',#15,3.);
#14=LINE('',#16,#17);
#15=AXIS2_PLACEMENT_3D('',#18,#19,#20);
#16=CARTESIAN_POINT('',(13.,20.,10.));
#17=VECTOR('',#21,2.);
#18=CARTESIAN_POINT('',(10.,20.,5.));
#19=DIRECTION('',(0.,0.,4.));
#20=DIRECTION('',(1.,0.,0.));
#21=DIRECTION('',(0.,0.,-1.));
"""


def drawn(text: str = CURVES) -> DrawnThread | None:
    return cylinders_in(text.encode(), [10, 99]).get(10)


def test_a_circle_and_a_line_along_its_axis_are_a_cylinder() -> None:
    found = drawn()
    assert np.allclose(found.point, (10.0, 20.0, 5.0)) and np.allclose(found.axis, (0, 0, 1))
    assert (found.radius, found.low, found.high) == (3.0, -5.0, 5.0)


def test_inches_of_the_context_are_converted() -> None:
    found = drawn(CURVES.replace("((#5,#3))", "((#5,#1))"))
    assert np.allclose(found.point, (254.0, 508.0, 127.0))
    assert (found.radius, found.low, found.high) == pytest.approx((76.2, -127.0, 127.0))


@pytest.mark.parametrize(
    ("was", "becomes"),
    [
        ("(13.,20.,10.)", "(14.,20.,10.)"),
        ("(#11,#12)", "(#11)"),
        ("(#11,#12)", "(#12)"),
        ("#15,3.)", "#15,$)"),
        ("CIRCLE('',#15,3.)", "CIRCLE('',#15,-3.)"),
        ("(0.,0.,4.)", "(0.,0.,0.)"),
        ("(0.,0.,4.)", "(0.,0.)"),
        ("((#5,#3))", "((#5))"),
        ("#8,#6,#10", "#8,#98,#10"),
        ("PARAMETER_VALUE(5.)", "PARAMETER_VALUE()"),
        ("#14=LINE('',#16,#17)", "#14=LINE('',#16)"),
        ("VECTOR('',#21,2.)", "VECTOR('',$,2.)"),
        ("AXIS2_PLACEMENT_3D('',#18,#19,#20)", "AXIS2_PLACEMENT_3D('',#18)"),
    ],
)
def test_what_is_no_cylinder_or_damaged_is_none(was: str, becomes: str) -> None:
    assert was in CURVES
    assert drawn(CURVES.replace(was, becomes)) is None
