"""The effects a scene switches on, in the order they are reported everywhere."""

from porolub.scene.scene import Scene


def effects(scene: Scene) -> list[str]:
    """Return the names of the effects the scene asks for."""
    pores, film, contact, load = scene.pores, scene.film, scene.contact, scene.load
    transient = scene.time is not None
    asked = {
        "solid": scene.solid is not None,
        "inertia": scene.solid is not None and scene.solid.inertia,
        "pores": pores is not None,
        "compressibility": pores is not None and pores.compressibility is not None,
        "carry": pores is not None and pores.carry,
        "film": film is not None,
        "squeeze": film is not None and film.squeeze and transient,
        "contact": contact is not None,
        "friction_traction": contact is not None and contact.friction_traction,
        "rotation": scene.motion is not None and scene.motion.kind == "rotation",
        "sliding": scene.motion is not None and scene.motion.kind == "sliding",
        "load": load is not None and load.force is not None,
        "approach": load is not None and load.approach is not None,
        "time": transient,
    }
    return [name for name, on in asked.items() if on]
