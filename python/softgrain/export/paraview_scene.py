"""Shows a run of softgrain in ParaView: paraview --script=scene.py"""

from pathlib import Path

from paraview.simple import (CellDatatoPointData, ColorBy, GetActiveViewOrCreate, GetAnimationScene,
                             GetColorTransferFunction, GetScalarBar, PVDReader, Render, ResetCamera, Show, Tube)

IN_SPACE = False
TOWARDS = (0, 0, 1)  # from the scene to the eye
GLASS = 0.35  # opacity of grains, through which contacts are seen; 1: surfaces alone

FOLDER = Path(".")
PRESSURES = (0, 1)  # [Pa]
RADIUS = 1  # [m]

view = GetActiveViewOrCreate("RenderView")
view.InteractionMode = "3D" if IN_SPACE else "2D"
view.UseColorPaletteForBackground = 0
view.Background = [1, 1, 1]
view.OrientationAxesVisibility = 0
colours = GetColorTransferFunction("pressure")
colours.ApplyPreset("Viridis (matplotlib)", True)
colours.AutomaticRescaleRangeMode = "Never"  # one range over all frames


def series(kind):
    return PVDReader(registrationName=kind, FileName=str(FOLDER / f"{kind}.pvd"))


def paint(display, colour):
    """One colour for all of it; ColorBy(display, None) fails in ParaView 5.11 where nothing is coloured yet."""
    display.ColorArrayName = ["POINTS", ""]
    display.DiffuseColor = display.AmbientColor = colour


def show_grains():
    """Their outlines as surfaces, behind the rest, coloured by the mean pressure of the grain; in space their surfaces, by
    the pressure behind each of their faces."""
    if IN_SPACE:
        display = Show(series("surfaces"), view)
        display.SetRepresentationType("Surface")
        display.Opacity = GLASS
        ColorBy(display, ("CELLS", "pressure"))
        display.SetScalarBarVisibility(view, True)
    elif "<DataSet" in (FOLDER / "grains.pvd").read_text():
        display = Show(series("grains"), view)
        display.SetRepresentationType("Surface With Edges")
        display.Opacity = GLASS
        ColorBy(display, ("CELLS", "pressure"))


def show_particles():
    """As disks of their radius, coloured by their pressure; in space grains are shown by their surfaces alone."""
    if IN_SPACE:
        return
    display = Show(series("particles"), view)
    display.SetRepresentationType("Point Gaussian")
    display.SetScaleArray = ["POINTS", "radius"]
    display.ScaleByArray = 1
    display.UseScaleFunction = 0
    display.GaussianRadius = 1.0
    display.ShaderPreset = "Plain circle"
    ColorBy(display, ("POINTS", "pressure"))
    display.SetScalarBarVisibility(view, True)


def show_legend():
    legend = GetScalarBar(colours, view)
    legend.Title = "pressure [Pa]"
    legend.TitleColor = legend.LabelColor = [0, 0, 0]
    legend.TitleFontSize = legend.LabelFontSize = 14
    legend.WindowLocation = "Lower Center"
    legend.Orientation = "Horizontal"
    legend.ScalarBarLength = 0.4
    colours.RescaleTransferFunction(*PRESSURES)  # ColorBy has changed it


def show_contacts():
    """Tubes between the particles, up to ten times as thick where the force is largest. None where grains are opaque."""
    if IN_SPACE and GLASS == 1:
        return
    forces = CellDatatoPointData(registrationName="forces", Input=series("contacts"))
    tubes = Tube(registrationName="tubes", Input=forces)
    tubes.Scalars = ["POINTS", "force"]
    tubes.VaryRadius = "By Scalar"
    tubes.Radius = 0.05 * RADIUS
    tubes.RadiusFactor = 10
    display = Show(tubes, view)
    display.Position = [0, 0, 0 if IN_SPACE else 2 * RADIUS]  # before the disks
    paint(display, [0.63, 0.11, 0.2])


def show_walls():
    display = Show(series("walls"), view)
    display.LineWidth = 1 if IN_SPACE else 3
    if IN_SPACE:
        display.SetRepresentationType("Wireframe")
    paint(display, [0.1, 0.1, 0.1])


for show in (show_grains, show_particles, show_contacts, show_walls, show_legend):
    show()
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().GoToLast()
if IN_SPACE:
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraPosition = list(TOWARDS)
    view.CameraViewUp = [0, 0, 1]
ResetCamera(view)
Render(view)
