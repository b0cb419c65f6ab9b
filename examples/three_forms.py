"""One controller in three forms: blocks, a Python class, the matrices of python-control; `python three_forms.py`.
The steering of `own_strategy.py`, without delays of its own. They give one result; what each costs is printed."""

import numpy as np

import control
import klingel as kl
from klingel.control import WHEELSETS, DiscreteController, Plant, PythonController, Timing, low_pass
from own_strategy import SpeedDifference

TS = 1e-3
VEHICLE = kl.library.vehicle("trailed_irw")
PLANT = Plant.of(VEHICLE)
PER_MOMENT = 1.0 / (2.0 * PLANT.steering.half_spacing)
MEASURED = [f"{w.name}.{what}" for w in WHEELSETS for what in ("yaw_rate", "left.spin_speed", "right.spin_speed")]
COMMANDS = [f"{w.name}.actuator_{side}.force" for w in WHEELSETS for side in ("left", "right")]

blocks = SpeedDifference(timing=Timing(TS, sensor_samples=0, computation_samples=0))
rate = blocks.gain / blocks.integral_time
low = low_pass(blocks.frequency, sample_time=TS)


class Stepped:
    """As a Python class: PI with a low-pass for each wheelset."""

    def reset(self):
        self.filters, self.integrals = {}, {}

    def step(self, t, measurements):
        commands = []
        for w in WHEELSETS:
            turning = self.slow(w.name, measurements[f"{w.name}.yaw_rate"])
            left, right = (measurements[f"{w.name}.{side}.spin_speed"] for side in ("left", "right"))
            error = PLANT.speed_ratio * turning - 0.5 * (left - right)
            integral, before = self.integrals.get(w.name, (0.0, error))
            integral += 0.5 * TS * rate * (error + before)
            self.integrals[w.name] = integral, error
            force = PER_MOMENT * (blocks.gain * error + integral)
            commands += [force, -force]
        return commands

    def slow(self, name, u):
        """One section, begun where its first input leads it."""
        (b0, b1, b2), (a1, a2) = low.b, low.a
        x1, x2 = self.filters.get(name, (u * (b1 + b2 - a1 - a2), u * (b2 - a2)))
        y = b0 * u + x1
        self.filters[name] = b1 * u - a1 * y + x2, b2 * u - a2 * y
        return y


python = PythonController(Stepped(), sample_time=TS, measurements=MEASURED, commands=COMMANDS)


def discrete():
    """As a discrete state space: 12 measurements, 8 commands."""
    z = control.tf([1, 0], [1], TS)
    one = control.ss([], [], [], [[1.0]], TS)
    slow = control.tf2ss(control.tf(low.b, (1.0, *low.a), TS))
    pi = control.tf2ss(blocks.gain + 0.5 * TS * rate * (z + 1) / (z - 1))
    error = control.ss([], [], [], [[PLANT.speed_ratio, -0.5, 0.5]], TS) * control.append(slow, one, one)
    forces = control.ss([], [], [], [[PER_MOMENT], [-PER_MOMENT]], TS) * pi * error
    return DiscreteController(control.append(*[forces] * 4), measurements=MEASURED, commands=COMMANDS)


def scenario(strategy, duration=None):
    """One curve."""
    track = kl.Track.curve(radius="800 m", cant="100 mm", transition="60 m", arc="100 m", straight_before="30 m")
    return kl.Scenario(VEHICLE, track, speed="40 m/s", control=strategy, duration=duration)


def main(repeats: int = 5) -> None:
    """Prints how far each form is from the blocks and what a run with it costs, each the best of a few."""
    forms = {"none": None, "blocks": blocks, "discrete": discrete(), "python": python}
    runs = {name: [kl.simulate(scenario(form)) for _ in range(repeats)] for name, form in forms.items()}
    costs = {name: min(run.attrs["cpu_time"] for run in each) for name, each in runs.items()}
    for name, (run, *_) in runs.items():
        apart = float(np.abs(run["bogie1.wheelset1.y"] - runs["blocks"][0]["bogie1.wheelset1.y"]).max())
        per_second = costs[name] / float(run.time[-1])
        per_evaluation = 1e6 * costs[name] / run.attrs["evaluations"]
        print(
            f"{name:9} y apart by {apart:.1e} m, {1e3 * per_second:.0f} ms a second, "
            f"{per_evaluation:.1f} us a right-hand side, {costs[name] / costs['none']:.2f} times no controller"
        )


if __name__ == "__main__":
    main()
