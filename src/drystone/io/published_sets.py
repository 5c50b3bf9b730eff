"""The published stone sets: where each file was released, and what it must contain."""

from dataclasses import dataclass

REPOSITORY = "eesd-epfl/StablePacking-2D"
"""Where the authors of the paper released the stones, under the MIT licence."""

RAW = f"https://raw.githubusercontent.com/{REPOSITORY}"
"""Address of its files, to be followed by a commit and a path."""

NOTICE = "LICENSE-StablePacking-2D.txt"
"""Name of the licence that is written beside the files, as it asks for."""

LICENCE = """\
MIT License

Copyright (c) 2024 qianqing-wanggg

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE.
"""

PAPER = (
    "Q. Wang, K. R. M. dos Santos and K. Beyer (2024), An image-based stacking method for 2D "
    "dry-stone masonry walls"
)
"""The paper that the files were released with."""


@dataclass(frozen=True)
class PublishedFile:
    """One file of a published set."""

    name: str  # where it belongs in a folder of published data, for example ``"almeida/R.png"``
    commit: str  # commit of the repository that it is taken from, 40 hexadecimal digits
    path: str  # its path there
    sha256: str  # what its bytes must hash to

    @property
    def address(self) -> str:
        """Where it follows :data:`RAW`."""
        return f"{self.commit}/{self.path}"


@dataclass(frozen=True)
class PublishedSet:
    """Files that belong together."""

    text: str  # what they show
    source: str  # whose stones they are: to be cited beside :data:`PAPER`
    files: tuple[PublishedFile, ...]  # label images, one id a stone


# The files lie in two commits: the repository has no release to name instead.
_WALLS = "51d0d033607310b1e15d561948f3495b361e9e44"
_MAIN = "e24a0dcec1fe9a9ca46710d186088ef704b3da38"

_ALMEIDA = (
    (
        "R",
        _WALLS,
        "galary_by_constrution_method/variant_two_bothsides_cutting_R",
        "62a493ea836e23accf6a8ec32fb78488f1153a1bcddf0b2ad33c9ce56159c823",
    ),
    (
        "PR",
        _MAIN,
        "PR",
        "2239bb1dd8cb76a852a2af07e559c36598832630f1fb9fad8aae04d23b46e011",
    ),
    (
        "IR",
        _WALLS,
        "galary_by_constrution_method/sample_twice_bothsides_cutting_IR",
        "c30b231063ea5ce5ca88e77fa3dc4b6d9ee5c31059fac92f410cdc7563a26dad",
    ),
)
_THANGAVELU = {
    10: "605bd54d3313ddb96d12e1cab1ad94985d1d81ba6a6e77fc5f973a2177814c3e",
    20: "132ab556fec769248b2581685e087cccd71dcc21f43b8114845a100cb77fa6fb",
    40: "efe89f2e936c5ca8169a6c46c9543b71e6d0991055a286ce1fe68da4fe18f33d",
    50: "a14da7a6f6f66357711b016f0bb5a0819a24f2ffdf5c00732e001afb6b70ac6e",
    70: "f165bbce912276812f0438a15edffcb7425d15135fc3e0d8ea33b8c6f41694b9",
}

SETS = {
    "almeida": PublishedSet(
        "walls of masons: regular (R), partially regular (PR) and irregular (IR) stones",
        "Almeida et al. (2021), Construction and Building Materials, "
        "https://www.sciencedirect.com/science/article/pii/S0950061821030804",
        tuple(
            PublishedFile(
                f"almeida/{name}.png",
                commit,
                f"Tests/Almeida/{folder}/data/wall_labels.png",
                digest,
            )
            for name, commit, folder, digest in _ALMEIDA
        ),
    ),
    "thangavelu": PublishedSet(
        "polygonal stones at the noise levels 10, 20, 40, 50 and 70",
        "V. Thangavelu, Y. Liu, M. Saboia and N. Napp (2018), Dry stacking for automated "
        "construction with irregular objects, IEEE International Conference on Robotics and "
        "Automation",
        tuple(
            PublishedFile(
                f"thangavelu/noise_{noise}.png",
                _WALLS,
                f"Tests/Thangavelu/data/stones_noise_{noise}_labels.png",
                digest,
            )
            for noise, digest in _THANGAVELU.items()
        ),
    ),
}
"""What there is, by name."""
