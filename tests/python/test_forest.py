"""ossa.Forest."""

import numpy as np
import pytest

import ossa


@pytest.fixture(scope="module")
def forest():
    return ossa.Forest()


def test_classify_agrees_with_the_tracker(forest, images, frames):
    depth_mm, camera, _ = images[-1]
    mask = frames[-1].users > 0
    parts, probabilities = forest.classify(depth_mm, camera, mask)
    assert parts.dtype == np.uint8 and probabilities.dtype == np.float32
    assert probabilities.shape == depth_mm.shape + (len(forest.classes),)
    assert not parts[~mask].any() and parts[mask & (depth_mm > 0)].all()
    assert np.allclose(probabilities[mask & (depth_mm > 0)].sum(-1), 1, atol=1e-3)
    # The tracker knows the facing from the frames before; alone the forest labels much the same.
    assert (parts == frames[-1].parts)[mask].mean() > 0.8


def test_propose_returns_every_target_best_first(forest, images, frames):
    depth_mm, camera, _ = images[-1]
    body = frames[-1].bodies[0]
    proposals = forest.propose(depth_mm, camera, frames[-1].users == body.id)
    assert list(proposals) == forest.targets
    assert np.linalg.norm(proposals["Head"].positions[0] - body["Head"]) < 0.1
    assert list(proposals["Head"].confidence) == sorted(proposals["Head"].confidence)[::-1]


def test_classify_finds_no_parts_in_an_image_without_readings(forest):
    nothing = np.zeros((48, 64), np.uint16)
    parts, probabilities = forest.classify(nothing, ossa.Camera.preset("kinect-v1"))
    assert not parts.any() and not probabilities.any()


def test_classify_refuses_a_mask_of_another_size(forest, images):
    with pytest.raises(ossa.InputError, match=r"mask: expected bool or uint8"):
        forest.classify(images[0].depth_mm, images[0].camera, np.ones((2, 2), bool))


def test_card_names_the_training_data(forest):
    assert forest.card


def test_forest_names_a_file_of_another_format(tmp_path):
    (tmp_path / "no.ossa").write_text("no forest")
    with pytest.raises(ossa.InputError, match="no.ossa"):
        ossa.Forest(tmp_path / "no.ossa")
