#!/usr/bin/env python3
"""Makes the JPEG files beside it with Pillow: kinds that our own encoder does not write.

    pip install numpy pillow
    make_images.py
"""

import pathlib

import numpy
from PIL import Image

HERE = pathlib.Path(__file__).parent
WIDTH, HEIGHT = 70, 46  # no multiple of a block's 8 or 16 pixels


def picture():
    """Saturated stripes, a slope and noise: steep edges for the transform, strong colours for the conversion."""
    rng = numpy.random.default_rng(20040927)
    y, x = numpy.mgrid[:HEIGHT, :WIDTH]
    rgb = numpy.stack([x * 255 // (WIDTH - 1), y * 255 // (HEIGHT - 1), 255 * (x // 5 % 2)], axis=2)
    rgb[10:20] = [255, 0, 255]
    rgb[30:, 40:] = rng.integers(0, 256, (HEIGHT - 30, WIDTH - 40, 3))
    return Image.fromarray(rgb.astype(numpy.uint8))


rgb = picture()
rgb.save(HERE / "subsampled_420.jpg", quality=85, subsampling="4:2:0")
rgb.save(HERE / "subsampled_422.jpg", quality=30, subsampling="4:2:2")
rgb.save(HERE / "progressive.jpg", quality=90, progressive=True, subsampling="4:2:0")
rgb.save(HERE / "restarts.jpg", quality=85, restart_marker_rows=1)
# Coefficients of every size; at low quality they overshoot the range of a pixel.
noise = numpy.random.default_rng(7).integers(0, 256, (HEIGHT, WIDTH, 3)).astype(numpy.uint8)
for quality in (1, 50, 100):
    Image.fromarray(noise).save(HERE / f"noise_{quality}.jpg", quality=quality, subsampling="4:4:4")
rgb.convert("L").save(HERE / "gray.jpg", quality=85)
rgb.convert("CMYK").save(HERE / "cmyk.jpg", quality=85)
