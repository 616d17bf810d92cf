"""Car bodies: the ways to give a coach its flexibility, each by its energies."""

from railride.bodies.base import BodyModel, Parameter, Place
from railride.bodies.beam import BeamBody, beam_modes
from railride.bodies.body_modes import BodyModes
from railride.bodies.modal import ModalBody
from railride.bodies.rigid import RigidBody
from railride.bodies.segments import SegmentedBody

__all__ = [
    "BeamBody",
    "BodyModel",
    "BodyModes",
    "ModalBody",
    "Parameter",
    "Place",
    "RigidBody",
    "SegmentedBody",
    "beam_modes",
]
