"""The vehicle in Exudyn, a nonlinear multibody program, from bodies, joints and spring-dampers.

Nothing is shared with railride but the parameters' values. Planar rigid bodies at one height:

- the car body's segments, hinged to one another, a torsional spring-damper at every hinge, linear
  in the angle between them; the body's middle is held along the track, whether it is a hinge or the
  middle of a segment. A segment that turns is shorter along the track, by cos φ, and moves those
  beyond it;
- the bogies, held along the track by their mass centres;
- springs and dampers that act vertically between the points of the bodies to which they are
  fixed, however these turn and wherever they come to lie along the track: a lever is l cos φ. The
  primary ones stand on the ground, and the track's elevation comes as the force k w + c ẇ, which is
  the same.

All is counted from static equilibrium, without weight or preloads: what their moments do in the
second order is in neither program. Exudyn keeps every body's coordinates (x, y, φ) and holds the
joints by constraints; it integrates by its generalised-α method, of second order in the step.

Source: J. Gerstmayr, Exudyn - a C++-based Python package for flexible multibody systems, Multibody
System Dynamics 60 (2024), 533-561.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import exudyn as exu
import exudyn.solver
import numpy as np
from exudyn import itemInterface as items  # noqa: N813
from vehicles import density


@dataclass(frozen=True)
class Segment:
    """A rigid part of the car body, from ``rear`` to ``front`` (m forward of the middle).

    mass : kg. centre : m, its mass centre. inertia : kg m², about that.
    """

    rear: float
    front: float
    mass: float
    centre: float
    inertia: float


def equal_rods(body, count):
    """The car body as ``count`` slender rods of equal mass, from the front."""
    length, mass = body.length / count, body.mass / count
    ends = body.length / 2 - length * np.arange(count + 1)
    return [
        Segment(rear, front, mass, (front + rear) / 2, mass * length**2 / 12)
        for front, rear in itertools.pairwise(ends)
    ]


def whole(body):
    """The rigid car body."""
    half = body.length / 2
    return [Segment(-half, half, body.mass, body.mass_centre, body.pitch_inertia)]


def graded(body, count):
    """The car body as ``count`` parts of equal length, its mass per length a parabola."""
    mu = density(body)
    points, weights = np.polynomial.legendre.leggauss(8)
    ends = body.length / 2 - body.length / count * np.arange(count + 1)
    parts = []
    for front, rear in itertools.pairwise(ends):
        x = (front + rear) / 2 + points * (front - rear) / 2
        dm = mu(x) * weights * (front - rear) / 2
        centre = dm @ x / dm.sum()
        parts.append(Segment(rear, front, dm.sum(), centre, dm @ (x - centre) ** 2))
    return parts


def coach_of(model, track=None):
    """The vehicle of a railride model, rigid or of equal segments, in Exudyn.

    The hinges are those of the model, calibrated as it says. track : as for :class:`Coach`.
    """
    body, count, values = model.vehicle.body, model.body.segments, model.values()
    if count == 1:
        return Coach(model.vehicle, whole(body), track=track)
    parts = {"rods": equal_rods, "graded": graded}[model.body.inertia](body, count)
    joints = float(values["k_theta"]), float(values["c_theta"])
    return Coach(model.vehicle, parts, joints, track)


def at_steps(under, step):
    """A track for :class:`Coach` that is known at the steps alone, where its integrator asks.

    under : elevations, then rates, of all wheelsets, (2 · wheelsets, samples). step : s, as run.
    """
    w, dw = np.split(np.asarray(under), 2)
    known = np.stack([w, dw], axis=-1).tolist()

    def track(j, t):
        k = round(t / step)
        if abs(k - t / step) > 1e-6:
            raise ValueError(f"track: found {t} s asked for; expected whole steps of {step} s")
        return known[j][k]

    return track


class Coach:
    """A vehicle in Exudyn.

    vehicle : its parameters. segments : of its car body, from the front. joints : torsional
    stiffness and damping of every hinge, N m/rad and N m s/rad. track : elevation and rate under
    wheelset j at time t, ``track(j, t) -> (w, dw)``, j from 0; none is a level track.
    """

    def __init__(self, vehicle, segments, joints=(0.0, 0.0), track=None):
        self.segments, self.track = segments, track
        self.system = exu.SystemContainer()
        self.mbs = self.system.AddSystem()
        self.ground = self._add(items.ObjectGround())
        self.origin = self._coordinate(self.mbs.AddNode(items.NodePointGround()), 0)
        self.parts = [self._body(s.centre, s.mass, s.inertia) for s in segments]
        self._hinge(*joints)
        self._hold_the_middle()
        wheelset = itertools.count()
        for bogie in vehicle.bogies:
            self._put_on_track(bogie, wheelset)

    def _add(self, item):
        return self.mbs.AddObject(item)

    def _marker(self, item):
        return self.mbs.AddMarker(item)

    def _body(self, x, mass, inertia):
        """Node and object of a rigid body."""
        node = self.mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=[x, 0, 0]))
        return node, self._add(items.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node))

    def _point(self, body, x):
        """A marker on a body, x from its mass centre."""
        return self._marker(items.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0, 0]))

    def _coordinate(self, node, which):
        """A marker on a node's x, y or φ: 0, 1 or 2."""
        return self._marker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=which))

    def _hinge(self, stiffness, damping):
        """Join neighbouring segments."""
        pairs = itertools.pairwise(zip(self.segments, self.parts, strict=True))
        for (ahead, (node_a, body_a)), (behind, (node_b, body_b)) in pairs:
            rear = self._point(body_a, ahead.rear - ahead.centre)
            front = self._point(body_b, behind.front - behind.centre)
            self._add(items.ObjectJointRevolute2D(markerNumbers=[rear, front]))
            turns = [self._coordinate(node_b, 2), self._coordinate(node_a, 2)]
            self._add(items.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=turns, stiffness=stiffness, damping=damping))  # fmt: skip

    def _hold_the_middle(self):
        """Hold the middle of the car body along the track."""
        segment, body = self._at(0.0)
        ends = [
            self._marker(items.MarkerBodyRigid(bodyNumber=one, localPosition=[x, 0, 0]))
            for one, x in ((self.ground, 0.0), (body, -segment.centre))
        ]
        self._add(items.ObjectJointGeneric(
            markerNumbers=ends, constrainedAxes=[1, 0, 0, 0, 0, 0]))  # fmt: skip

    def _at(self, x):
        """The segment that a point of the body belongs to, and its body."""
        k = next(k for k, s in enumerate(self.segments) if s.rear <= x)
        return self.segments[k], self.parts[k][1]

    def _put_on_track(self, bogie, wheelset):
        """A bogie under the car body and on its wheelsets."""
        node, body = self._body(bogie.position, bogie.mass, bogie.pitch_inertia)
        held = [self.origin, self._coordinate(node, 0)]
        self._add(items.ObjectConnectorCoordinate(markerNumbers=held))
        segment, above = self._at(bogie.position)
        self._spring(self._point(body, 0.0), self._point(above, bogie.position - segment.centre),
                     bogie.secondary_stiffness, bogie.secondary_damping)  # fmt: skip
        k, c = bogie.primary_stiffness, bogie.primary_damping
        for lever in bogie.wheelsets:
            axle = self._point(body, lever)
            self._spring(self._point(self.ground, bogie.position + lever), axle, k, c)
            if self.track is not None:
                self._lift(axle, next(wheelset), k, c)

    def _spring(self, below, above, stiffness, damping):
        """A spring and a damper that feel the heights alone."""
        along_z = {"stiffness": [0, stiffness, 0], "damping": [0, damping, 0]}
        ends = [below, above]
        self._add(items.ObjectConnectorCartesianSpringDamper(markerNumbers=ends, **along_z))

    def _lift(self, axle, j, stiffness, damping):
        """The track's part of the primary suspension's force."""

        def force(_mbs, t, _load):
            w, dw = self.track(j, t)
            return [0.0, float(stiffness * w + damping * dw), 0.0]

        self.mbs.AddLoad(items.Force(markerNumber=axle, loadVector=[0, 0, 0],
                                     loadVectorUserFunction=force))  # fmt: skip

    def frequencies(self):
        """Undamped natural frequencies, Hz, ascending."""
        self.mbs.Assemble()
        found, _ = self.mbs.ComputeODE2Eigenvalues(convert2Frequencies=True)
        return np.sort(np.asarray(found))

    def eigenvalues(self):
        """Eigenvalues λ of the damped vehicle, 1/s, those with Im λ ≥ 0, by |λ|."""
        self.mbs.Assemble()
        found, _ = self.mbs.ComputeODE2Eigenvalues(
            computeComplexEigenvalues=True, useAbsoluteValues=False
        )
        found = np.asarray(found)
        return np.array(sorted(found[found.imag >= 0], key=abs))

    def run(self, stop, step, at):
        """Times, and accelerations (points, steps) of points ``at`` of the segments' polygon."""
        kept = {"storeInternal": True, "outputVariableType": exu.OutputVariableType.Acceleration}
        sensors = []
        for x in at:
            segment, body = self._at(x)
            place = [x - segment.centre, 0, 0]
            sensor = items.SensorBody(bodyNumber=body, localPosition=place, **kept)
            sensors.append(self.mbs.AddSensor(sensor))
        self.mbs.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps = round(stop / step)
        settings.timeIntegration.endTime = stop
        # Below 1, or the noise of the constraints grows over a long run.
        settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
        settings.timeIntegration.newton.relativeTolerance = 1e-10
        settings.timeIntegration.newton.absoluteTolerance = 1e-12
        settings.timeIntegration.newton.useModifiedNewton = True
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = step
        self.mbs.SolveDynamic(settings)
        data = [np.asarray(self.mbs.GetSensorStoredData(sensor)) for sensor in sensors]
        return data[0][:, 0], np.array([values[:, 2] for values in data])
