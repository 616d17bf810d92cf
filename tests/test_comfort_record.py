"""A measured record checks itself."""

import math

import numpy as np
import pytest

from railride.comfort import AccelerationRecord, Axis
from railride.errors import InputError


def axis(column="z", direction="z", lengths=(100, 50)):
    return Axis(column, direction, tuple(np.arange(float(n)) for n in lengths))


def record(rate=100.0, starts=(0.0, 2.0), axes=None):
    return AccelerationRecord("run", rate, starts, (axis(),) if axes is None else axes)


def test_what_a_record_holds():
    found = record(axes=[axis("x", "x"), axis("z", "z")])
    assert found.lengths == (100, 50)
    assert found.duration == 1.5
    assert isinstance(found.axes, tuple)
    with pytest.raises(ValueError, match="read-only"):
        found.axes[0].pieces[0][0] = 1.0


def test_the_callers_array_stays_the_callers():
    own = np.zeros(10)
    Axis("z", "z", (own,))
    own[0] = 1.0


def test_pieces_may_follow_at_once_and_start_half_a_sample_off():
    assert record(starts=(5.0, 6.0)).starts == (5.0, 6.0)
    assert record(starts=(5.0, 5.996)).starts == (5.0, 5.996)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rate": 0.0}, "sampling rate.*0.0 Hz"),
        ({"rate": math.nan}, "sampling rate"),
        ({"axes": ()}, "axes: found none"),
        ({"axes": (axis(lengths=()),), "starts": ()}, "no piece"),
        ({"axes": (axis(lengths=(5, 0)),)}, r"piece 1.*shape \(0,\)"),
        ({"axes": (Axis("z", "z", (np.zeros((2, 2)),)),)}, r"piece 0.*shape \(2, 2\)"),
        ({"axes": (axis(), axis())}, "'z' 2 times"),
        ({"axes": (axis(), axis("y", "up"))}, "direction 'up'"),
        ({"axes": (axis(), axis("y", "y", (100, 51)))}, r"column y: found pieces of \(100, 51\)"),
        ({"axes": (axis(), axis("y", "y", (100,)))}, r"column y: found pieces of \(100,\)"),
        ({"axes": (Axis("z", "z", (np.array([0.0, math.inf]), np.zeros(3))),)},
         "column z, piece 0.*inf at sample 1"),
        ({"starts": (0.0,)}, "starts.*2 finite times"),
        ({"starts": (0.0, math.nan)}, "starts.*2 finite times"),
        ({"starts": (0.0, 0.5)}, "piece 1.*0.5 s.*ends at 0.995 s"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_a_record(change, message):
    with pytest.raises(InputError, match=message):
        record(**change)


def test_all_faults_are_told_together():
    with pytest.raises(InputError) as caught:
        record(rate=-1.0, axes=(Axis("z", "z", (np.array([math.nan]), np.zeros(0))),))
    for part in ("record run", "sampling rate", "piece 0", "piece 1"):
        assert part in str(caught.value)
