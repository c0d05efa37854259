# SPDX-License-Identifier: MIT
"""The models that can be exported. Facts only: nothing here imports torch or a model."""

from contract.card import IMAGENET_MEAN, IMAGENET_STD, ModelCard
from contract.errors import BAD_USAGE, ExportError

_DA3_INSTALL = ("pip install --no-deps depth-anything-3; "
                "pip install addict einops omegaconf huggingface_hub")
_FACEBOOK_INSTALL = "a checkout of github.com/facebookresearch/{} and --package-path"

_ACROSS_VIEWS = "attention across the views begins inside its encoder"
_SHARE = "its image encoder is the smaller part of the work, and is not taken apart here"

_CARDS = (
    ModelCard(
        name="da3-small", module="depth_anything_3", package="depth_anything_3",
        install=_DA3_INSTALL, weights="huggingface.co/depth-anything/DA3-SMALL",
        license="Apache-2.0", products=True, size=(224, 308), mean=IMAGENET_MEAN,
        std=IMAGENET_STD, unsplit=_ACROSS_VIEWS),
    ModelCard(
        name="da3-base", module="depth_anything_3", package="depth_anything_3",
        install=_DA3_INSTALL, weights="huggingface.co/depth-anything/DA3-BASE",
        license="Apache-2.0", products=True, size=(378, 504), mean=IMAGENET_MEAN,
        std=IMAGENET_STD, unsplit=_ACROSS_VIEWS),
    ModelCard(
        name="vggt", module="vggt_model", package="vggt",
        install=_FACEBOOK_INSTALL.format("vggt"), weights="huggingface.co/facebook/VGGT-1B",
        license="VGGT-1B: no commercial use; VGGT-1B-Commercial: VGGT License v1", products=False,
        size=(392, 518), unsplit=_SHARE),
    ModelCard(
        name="vggt-omega", module="vggt_omega_model", package="vggt_omega",
        install=_FACEBOOK_INSTALL.format("vggt-omega"),
        weights="huggingface.co/facebook/VGGT-Omega (on request)",
        license="FAIR Noncommercial Research License", products=False, multiple=16,
        size=(416, 624), unsplit=_SHARE),
    ModelCard(
        name="pi3", module="pi3_model", package="pi3",
        install="a checkout of github.com/yyfz/Pi3 and --package-path",
        weights="huggingface.co/yyfz233/Pi3", license="CC-BY-NC-4.0 (weights)",
        products=False, size=(392, 518), confidence="sigmoid", reference_view="none",
        unsplit=_SHARE),
    ModelCard(
        name="sta", module="sta_model", package="vista_slam",
        install="a checkout of github.com/zhangganlin/vista-slam and --package-path",
        weights="huggingface.co/zhangganlin/vista_slam",
        license="Apache-2.0 with CC-BY-NC-SA-4.0 parts", products=False, kind="pair", multiple=16,
        size=(224, 224), mean=(0.5, 0.5, 0.5), std=(0.5, 0.5, 0.5), resize="crop",
        reference_view="none"),
    ModelCard(
        name="mapanything", module="map_anything_model", package="mapanything",
        install=_FACEBOOK_INSTALL.format("map-anything") + ", pip install hydra-core "
        "huggingface_hub; pip install --no-deps uniception==0.1.7",
        weights="huggingface.co/facebook/map-anything, .../map-anything-apache",
        license="map-anything: CC-BY-NC-4.0; map-anything-apache: Apache-2.0", products=False,
        size=(392, 518), mean=IMAGENET_MEAN, std=IMAGENET_STD, scale="metric"),
    ModelCard(
        name="salad", module="salad_model", package="models.aggregators.salad",
        install="a checkout of github.com/serizba/salad and --package-path, "
                "pip install timm",
        weights="dino_salad.ckpt of github.com/serizba/salad/releases", license="GPL-3.0",
        products=False, kind="descriptor", size=(224, 308), mean=IMAGENET_MEAN,
        std=IMAGENET_STD, resize="stretch", unsplit="a descriptor is computed once per keyframe"),
)

CARDS = {card.name: card for card in _CARDS}


def find_card(name: str) -> ModelCard:
    if name not in CARDS:
        raise ExportError(f"model {name}: not known; there are {' '.join(CARDS)}", BAD_USAGE)
    return CARDS[name]
