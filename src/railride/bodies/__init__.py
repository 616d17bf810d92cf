"""Car bodies: the ways to give a coach its flexibility, each by its energies."""

from railride.bodies.base import BodyModel, Parameter
from railride.bodies.rigid import RigidBody
from railride.bodies.segments import SegmentedBody

__all__ = ["BodyModel", "Parameter", "RigidBody", "SegmentedBody"]
