"""A steering strategy of one's own in twenty lines, beside the library's, through one curve: `python own_strategy.py`.
Wheels that turn freely tell by their speed difference where a wheelset runs; the actuators steer it to the middle."""

from dataclasses import dataclass

import matplotlib.pyplot as plt

import klingel as kl
from klingel.control import WHEELSETS, Composed, Plant, command_steering, low_pass, speed_difference


@dataclass(frozen=True, kw_only=True)
class SpeedDifference(Composed):
    """PI on lambda r/r0 - wd: the speed difference that the wheelset's own turning makes, less what is measured."""

    gain: float = 4e4  # [N m s/rad]
    integral_time: float = 0.5  # [s]
    frequency: float = 1.5  # of the gyro's low-pass [Hz]

    def build(self, d, vehicle, track, speed):
        plant, slow = Plant.of(vehicle), low_pass(self.frequency, sample_time=d.sample_time)
        for w in WHEELSETS:
            rate = d.filter(f"{w.name}.rate", d.measure(f"{w.name}.yaw_rate"), [slow])
            error = d.sum(f"{w.name}.error", {rate: plant.speed_ratio, speed_difference(d, w, self.timing): -1.0})
            moment = d.pi(f"{w.name}.M", error, proportional=self.gain, integral=self.gain / self.integral_time)
            command_steering(d, plant, w, moment, self.timing)


def main() -> None:
    """Prints the largest displacement with three strategies and writes `own_strategy.png`."""
    vehicle = kl.library.vehicle("trailed_irw")
    straights = {"straight_before": "50 m", "straight_after": "50 m"}
    track = kl.Track.curve(radius="800 m", cant="160 mm", transition="80 m", arc="80 m", **straights)
    figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
    for strategy in (kl.control.PassiveIRW(), SpeedDifference(), kl.control.TrailedIRW()):
        run = kl.simulate(kl.Scenario(vehicle, track, speed="144 km/h", control=strategy))
        name, y = type(strategy).__name__, 1e3 * run["bogie1.wheelset1.y"]
        print(f"{name:16} {run.attrs['outcome']}, largest |y| of the first wheelset {float(abs(y).max()):.2f} mm")
        axes.plot(run["bogie1.wheelset1.s"], y, label=name)
    axes.set(xlabel="place [m]", ylabel="lateral displacement [mm]")
    axes.legend()
    figure.savefig("own_strategy.png")


if __name__ == "__main__":
    main()
