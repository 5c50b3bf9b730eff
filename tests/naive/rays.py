"""Slow, obvious twin of the local filling ratio: rays are shot pixel by pixel (Eq. 4, Fig. 7)."""


def local_filling_ratio(occupied, mask, row, col):
    height = occupied.shape[0]
    stone = {
        (row + i, col + j) for i in range(mask.shape[0]) for j in range(mask.shape[1]) if mask[i, j]
    }
    swept = set()
    for r, c in stone:
        swept |= {(r, x) for x in range(c)}
        swept |= {(y, c) for y in range(r + 1, height)}
    swept -= stone
    if not swept:
        return 1.0
    return sum(bool(occupied[at]) for at in swept) / len(swept)
