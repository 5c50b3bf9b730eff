"""Slow, obvious twin of drystone.contacts.gaps."""


def lies_between(labels, row, col):
    """Whether a way to a side and the opposite way end at two blocks, or a stone and the ground.

    Slantwise ways count as well, since joints meet at corners.
    """
    height, width = labels.shape

    def first_in(down, right):
        r, c = row, col
        while 0 <= r < height and 0 <= c < width:
            if labels[r, c]:
                return int(labels[r, c])
            r, c = r + down, c + right
        return -1 if r == height else 0

    ways = ((0, 1), (1, 0), (1, 1), (1, -1))
    ends = [(first_in(down, right), first_in(-down, -right)) for down, right in ways]
    return any(a and b and a != b for a, b in ends)
