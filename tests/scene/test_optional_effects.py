"""Effects a scene can add: inertia, a compressible fluid, friction that passes zero speed."""

from typing import Any

import pytest

from porolub.errors import SceneError
from porolub.scene import Scene, effects, estimate_unknowns, scene_from_dict
from tests.scene.scenes import ROLLING, changed


def scene(**sections: Any) -> Scene:
    return scene_from_dict(changed(ROLLING, **({"time": {"end": "5 s"}} | sections)))


def refusal(**sections: Any) -> str:
    with pytest.raises(SceneError) as caught:
        scene(**sections)
    return str(caught.value)


INERTIA: dict[str, Any] = {"inertia": True, "density": "1100 kg/m^3"}


def test_inertia_is_an_effect_with_a_velocity_for_each_displacement() -> None:
    moving = scene(solid=INERTIA)
    assert effects(moving)[:3] == ["solid", "inertia", "pores"]
    count = estimate_unknowns(moving)
    assert list(count)[:3] == ["displacement", "velocity", "pore_pressure"]
    assert count["velocity"] == count["displacement"]
    assert count["total"] == sum(v for k, v in count.items() if k != "total")


def test_without_inertia_there_is_no_velocity() -> None:
    still = scene(solid={"density": "1100 kg/m^3"})
    assert "inertia" not in effects(still)
    assert "velocity" not in estimate_unknowns(still)


def test_inertia_needs_density_and_time() -> None:
    assert "needs solid.density" in refusal(solid={"inertia": True})
    text = refusal(solid=INERTIA, time=None)
    assert text.startswith("solid.inertia = true needs a [time] section")


@pytest.mark.parametrize("order", [1, 2])
def test_inertia_is_for_orders_that_let_no_vibration_grow(order: int) -> None:
    """BDF of order 3 is unstable along most of the imaginary axis up to 1.94i."""
    assert scene(solid=INERTIA, time={"end": "5 s", "order": order}).time is not None
    text = refusal(solid=INERTIA, time={"end": "5 s", "order": 3})
    assert text.startswith("time.order = 3 with solid.inertia = true")
    assert text.endswith("allowed there: 1 and 2.")


FLUID: dict[str, Any] = {"compressibility": "0.1 1/GPa", "porosity": 0.8}


def test_compressibility_is_an_effect_of_steady_and_transient_scenes() -> None:
    for sections in ({}, {"time": None}):
        fluid = scene(pores=FLUID, **sections)
        assert effects(fluid)[1:4] == ["pores", "compressibility", "carry"]
        assert fluid.pores is not None
        assert (fluid.pores.compressibility, fluid.pores.porosity) == (1e-10, 0.8)


def test_without_compressibility_the_density_is_constant() -> None:
    plain = scene(pores={"porosity": 0.8})
    assert "compressibility" not in effects(plain)
    assert plain.pores is not None
    assert plain.pores.compressibility is None


def test_compressibility_needs_the_porosity() -> None:
    text = refusal(pores={"compressibility": "0.1 1/GPa"})
    assert text.startswith("pores.compressibility needs pores.porosity")
    assert "pores.porosity = 1.2" in refusal(pores=FLUID | {"porosity": 1.2})
    assert "greater than 0" in refusal(pores=FLUID | {"compressibility": "0 1/Pa"})


def test_storage_holds_the_fluid_s_own_compression() -> None:
    """S = eps_0 chi + (1 - a)(a - eps_0)/K; Table 3 of the paper gives 2.08 1/GPa."""
    own = "8e-11 1/Pa"
    assert scene(pores=FLUID | {"storage": own}).pores is not None
    text = refusal(pores=FLUID | {"storage": "7.9e-11 1/Pa"})
    assert text.startswith("pores.storage = 7.9e-11 1/Pa must be at least pores.porosity *")
    assert own in text


def test_friction_has_a_speed_at_which_it_turns_round() -> None:
    assert scene().contact is not None
    assert scene_from_dict(ROLLING).contact == scene().contact
    contact = scene(contact={"friction_speed": "2 mm/s"}).contact
    assert contact is not None
    assert contact.friction_speed == 2e-3
    assert "contact.friction_speed" in refusal(contact={"friction_speed": "0 m/s"})
