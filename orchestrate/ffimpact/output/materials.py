"""Materials of bodies and of their layers in words, from the tables of a scene as used."""

from ..input.parameters import Table

__all__ = ["layer_lines", "layer_name", "material"]


def material(table: Table) -> str:
    """Returns the law of a body or a layer and its numbers; of a rigid body its density."""
    if table.get("rigid"):
        return "rigid" if "mass" in table else f"rigid, density = {table['density']:g} kg/m3"
    words = [
        table["law"],
        f"young = {table['young']:g} Pa",
        f"nu = {table['nu']:g}",
        f"density = {table['density']:g} kg/m3",
    ]
    words += [
        f"{name} = {table[name]:g}{unit}"
        for name, unit in (("loss", ""), ("viscosity", " Pa s"), ("bulk_viscosity", " Pa s"))
        if table.get(name)
    ]
    return ", ".join(words)


def layer_name(layer: Table, number: int) -> str:
    """Returns the name of a layer, "layer 2" without one."""
    return layer.get("name") or f"layer {number}"


def layer_lines(body: Table) -> list[str]:
    """Returns a line for each layer of a body: its name, where it is, and its material."""
    return [
        f"{layer_name(layer, k)} of {body['name']}: {_place(layer)}, {material(layer)}"
        for k, layer in enumerate(body.get("layer", []), 1)
    ]


def _place(layer: Table) -> str:
    """Returns where a layer is."""
    if "radius" in layer:
        return f"inside {layer['radius']:g} m"
    if "group" in layer:
        return f"group {layer['group']}"
    kind, *numbers = layer["where"].items()
    return ", ".join([str(kind[1]), *(f"{name} = {value}" for name, value in numbers)])
