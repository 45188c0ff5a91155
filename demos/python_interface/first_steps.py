# %% [markdown]
# # First steps in Python
#
# A pair of spur gears is loaded from its scene, simulated, looked at, changed and simulated again.
# Run this file from top to bottom (`demos/python_interface/run`), or cell by cell: VS Code, Spyder and Jupyter with
# Jupytext open it as a notebook.

# %%
import sys
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

# The checkout, from any folder in it; its path is not needed where fenics_gears is installed.
CHECKOUT = next(
    folder for folder in (Path.cwd(), *Path.cwd().parents) if (folder / "demos" / "lundvall2004.toml").is_file()
)
sys.path.insert(0, str(CHECKOUT))
PICTURES = CHECKOUT / "results" / "python_interface"
PICTURES.mkdir(parents=True, exist_ok=True)

from fenics_gears import load_scene, simulate
from fenics_gears.results import by_pair, shown

# %% [markdown]
# ## A scene
#
# A scene says what is simulated. Read from its file it is a frozen dataclass, checked, in N, mm, s and rad; a section
# that the file does not have is `None`, and that effect is not there.

# %%
paper = load_scene(CHECKOUT / "demos" / "lundvall2004.toml")
print(paper.title)
print("load:", paper.load)
print("motion:", paper.motion)
print("friction:", paper.friction)
print("tip relief:", paper.tip_relief)

# %% [markdown]
# ## A run
#
# `simulate` returns an `xarray.Dataset`. Everything in it has a name, dimensions and units; about the run as a whole
# there are attributes.

# %%
result = simulate(paper)
print(result)

# %%
for name in ("transmission_error", "normal_force", "pair_normal_force", "contact_pressure"):
    variable = result[name]
    print(f"{name} ({', '.join(variable.dims)}): {variable.attrs['long_name']}, {variable.attrs['units']}")
print("warnings:", result.attrs["warnings"] or "none")

# %% [markdown]
# The transmission error is an angle of the wheel; as a length on its base circle it compares with tolerances and
# reliefs. Steps are best counted in mesh cycles.

# %%
radius = result.attrs["base_radius_wheel"]  # mm


def micrometres(run: xr.Dataset) -> xr.DataArray:
    """Transmission error on the wheel's base circle over the last mesh cycles, which pictures show, um."""
    error = shown(run)["transmission_error"].swap_dims(time="mesh_phase") * radius * 1e3
    return error.assign_attrs(long_name="transmission error", units="µm")


with_friction = micrometres(result)
print(f"mean {with_friction.mean().item():.1f} um, peak to peak {np.ptp(with_friction.values):.1f} um")

# %% [markdown]
# ## The same without friction
#
# Scenes are not changed; `dataclasses.replace` makes another one. `None` takes an effect away: its unknowns, its terms
# and its variables are not there.

# %%
frictionless = simulate(replace(paper, friction=None))
print("friction force with friction:", "friction_force" in result, "- without:", "friction_force" in frictionless)

# %%
figure, (above, below) = plt.subplots(2, sharex=True, figsize=(9, 6.5), layout="constrained")
with_friction.plot(ax=above, label="μ = 0.1")
micrometres(frictionless).plot(ax=above, label="μ = 0", linestyle="--")
above.set(title="The paper's pair at 200 Hz", xlabel="", ylabel="Transmission error (µm)")
above.legend()
# A pair keeps one of a few slots while it is in reach; `by_pair` gives each its own curve.
force = by_pair(shown(result)["pair_normal_force"]).swap_dims(time="mesh_phase") / 1e3
force.where(force > 0.0).plot.line(ax=below, x="mesh_phase", hue="pair")
below.set(xlabel="Time (mesh cycles)", ylabel="Force of a tooth pair (kN)", xlim=(28, 30), ylim=(0, None))
below.get_legend().set_title("tooth pair")
figure.savefig(PICTURES / "curves.png", dpi=110)

# %% [markdown]
# ## A small parameter study
#
# A loop is enough. A `GearStore` keeps the gears and their contact operators from run to run, so that runs which differ
# in speed, torque or drivetrain take only the time to march. (Large studies: `gears study`, under mpirun, with files
# that a stopped study goes on from.)

# %%
from fenics_gears.runs.gear_store import GearStore

store = GearStore()
frequencies = [100, 150, 180, 200, 210, 220, 240, 280, 350, 500]  # Hz
torques = [200, 437, 700]  # N m

values = np.empty((len(torques), len(frequencies)))
for i, torque in enumerate(torques):
    for j, frequency in enumerate(frequencies):
        load = replace(paper.load, wheel_torque=1e3 * torque)  # N mm
        motion = replace(paper.motion, mesh_frequency=frequency)
        run = simulate(replace(paper, load=load, motion=motion), preparation=store.prepared)
        values[i, j] = run.attrs["peak_to_peak_transmission_error"] * radius * 1e3

study = xr.DataArray(values, {"torque": torques, "mesh_frequency": frequencies}, name="T_EPP")
print(study.to_pandas().round(1))

# %% [markdown]
# What an effect takes is a dataclass, too. A relief of both tips, by its depth in mm and its start as a roll angle;
# `None` starts it at the highest point of single tooth contact.

# %%
from fenics_gears.geometry.relief import Relief
from fenics_gears.effects.tip_relief import TipRelief

relieved = simulate(replace(paper, tip_relief=TipRelief(pinion=Relief(0.028, None), wheel=Relief(0.028, None))))
print(f"peak to peak with tip relief: {np.ptp(micrometres(relieved).values):.1f} um")

# %% [markdown]
# ## Spectrum
#
# In the steady state the transmission error repeats with every mesh cycle, so that a Fourier transform over whole
# cycles gives its mesh orders exactly. (Errors of single teeth take longer to repeat: see `demos/flank_errors`.)


# %%
def mesh_orders(run: xr.Dataset, highest: int = 6) -> np.ndarray:
    """Amplitudes (highest,) of the first mesh orders, um."""
    cycles = micrometres(run).size // int(run.attrs["steps_per_mesh_cycle"])
    error = micrometres(run).values[:-1]  # the last step is the first of the next cycle
    return 2.0 * np.abs(np.fft.rfft(error))[cycles : highest * cycles + 1 : cycles] / len(error)


figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.5), layout="constrained")
study.plot.line(ax=left, x="mesh_frequency", marker="o", add_legend=False)
left.legend([f"{torque} N m" for torque in torques])
left.set(
    title="Three torques, friction 0.1",
    xlabel="Mesh frequency (Hz)",
    ylabel="Transmission error,\npeak to peak (µm)",
    ylim=(0, None),
)
for place, (label, run) in enumerate({"true involutes": result, "tip relief of 28 µm": relieved}.items()):
    right.bar(np.arange(1, 7) + 0.4 * place - 0.2, mesh_orders(run), 0.38, label=label)
right.set(title="Orders at 200 Hz and 437 N m", xlabel="Mesh order", ylabel="Amplitude (µm)", yscale="log")
right.legend()
figure.savefig(PICTURES / "study_and_spectrum.png", dpi=110)

# %% [markdown]
# ## Stress
#
# A run stores contact forces; displacement and stress of both gears follow from them at any stored step.

# %%
from fenics_gears.simulation.run_stresses import RunStresses
from fenics_gears.show.drawn_scale import automatic_scale
from fenics_gears.show.stress_picture import colour_limit, stress_picture

with RunStresses(result, paper) as stresses:
    mesh = stresses.at(
        int(result.attrs["steps_per_mesh_cycle"]) // 4
    )  # a quarter of a mesh cycle after the first stored step
for name, gear in zip(("pinion", "wheel"), mesh.gears):
    print(f"{name}: {gear.von_mises.size} nodes, largest von Mises stress {gear.von_mises.max():.0f} MPa")
figure = stress_picture(mesh, result, scale=automatic_scale([mesh]), limit=colour_limit([mesh]))
figure.savefig(PICTURES / "stress.png")
figure  # a notebook shows it

# %% [markdown]
# ## Keep it
#
# A result goes to NetCDF, as `gears run` writes it, and comes back. `gears plot` and `gears picture` take such a file
# as well.

# %%
from fenics_gears import results

results.save(result, PICTURES / "run.nc")
again = results.load(PICTURES / "run.nc")
print("read back the same:", again.identical(result))
print(*sorted(PICTURES.iterdir()), sep="\n")
