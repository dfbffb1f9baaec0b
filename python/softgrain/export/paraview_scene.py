"""Shows a run of softgrain in ParaView: paraview --script=scene.py"""

from pathlib import Path

from paraview.simple import (CellDatatoPointData, ColorBy, GetActiveViewOrCreate, GetAnimationScene,
                             GetColorTransferFunction, PVDReader, Render, ResetCamera, Show, Tube)

FOLDER = Path(".")
PRESSURES = (0, 1)  # [Pa]
RADIUS = 1  # [m]

view = GetActiveViewOrCreate("RenderView")
view.InteractionMode = "2D"
colours = GetColorTransferFunction("pressure")
colours.ApplyPreset("Viridis (matplotlib)", True)
colours.RescaleTransferFunction(*PRESSURES)


def series(kind):
    return PVDReader(registrationName=kind, FileName=str(FOLDER / f"{kind}.pvd"))


def show_grains():
    """Their outlines as surfaces, behind the rest, coloured by the mean pressure of the grain."""
    if "<DataSet" in (FOLDER / "grains.pvd").read_text():
        display = Show(series("grains"), view)
        display.SetRepresentationType("Surface With Edges")
        display.Opacity = 0.35
        ColorBy(display, ("CELLS", "pressure"))


def show_particles():
    """As disks of their radius, coloured by their pressure."""
    display = Show(series("particles"), view)
    display.SetRepresentationType("Point Gaussian")
    display.SetScaleArray = ["POINTS", "radius"]
    display.ScaleByArray = 1
    display.UseScaleFunction = 0
    display.GaussianRadius = 1.0
    ColorBy(display, ("POINTS", "pressure"))
    display.SetScalarBarVisibility(view, True)


def show_contacts():
    """Tubes between the particles, up to ten times as thick where the force is largest."""
    forces = CellDatatoPointData(registrationName="forces", Input=series("contacts"))
    tubes = Tube(registrationName="tubes", Input=forces)
    tubes.Scalars = ["POINTS", "force"]
    tubes.VaryRadius = "By Scalar"
    tubes.Radius = 0.05 * RADIUS
    tubes.RadiusFactor = 10
    display = Show(tubes, view)
    ColorBy(display, None)
    display.DiffuseColor = [0.63, 0.11, 0.2]


def show_walls():
    display = Show(series("walls"), view)
    display.LineWidth = 3
    ColorBy(display, None)
    display.DiffuseColor = [0.1, 0.1, 0.1]


for show in (show_grains, show_particles, show_contacts, show_walls):
    show()
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().GoToLast()
ResetCamera(view)
Render(view)
