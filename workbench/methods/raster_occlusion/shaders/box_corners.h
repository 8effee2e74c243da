// Two triangles a face of a box, three bits a corner; and of a square, two.
const uint kCorners[36] = uint[](0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5, 0, 1,
                                 4, 1, 5, 4, 2, 6, 3, 3, 6, 7);
const uint kSquare[6] = uint[](0, 1, 2, 2, 1, 3);
