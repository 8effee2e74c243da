// What rounding can do, wherever the library calls something sure. u = 2^-24 is what one operation in single
// precision loses of its result at most; "n u of M" is an error of n·u times the sum M of the terms'
// magnitudes. Rounding errors of a second order (u²) are left out of the counts.
//
// "Needs s": the worst case that tests/geometry/*_bounds_test.cpp finds takes the share s of the bound; the
// test fails when the bound is halved, or doubled. What a share below 1/2 leaves is slack, and said to be.
#pragma once

#include <cmath>

namespace sightline::geometry {

inline constexpr double kUnit = 0x1p-24;  ///< u

// --- planes and projections ---

/// ((a·x + b·y) + c·z) + d, coefficients rounded once: of a·x the coefficient, the product and three sums
/// round, of d the coefficient and a sum: at most 5 u of Σ. Needs 0.6.
inline constexpr double kPlaneRounding = 8 * kUnit;
/// A sphere's centre lies up to a radius beyond what planes are rounded for: 5 u of the radius, the product
/// with this rounds once more, and this itself.
inline constexpr float kRadiusGrowth = 1 + 8 * static_cast<float>(kUnit);
/// A plane whose normal is this small beside its distance lies at infinity: what is left of a normal that
/// cancels in double precision is some 2^-53 of it. Decides no more than which planes never reject.
inline constexpr double kPlaneAtInfinity = 1e-12;
/// A row of world_to_clip times a point: 5 u of Σ as above. Needs 0.4: more than twice too large.
inline constexpr double kProjectionRounding = 12 * kUnit;
/// Pixels. (x + 1)·size/2 less a slack rounds three times: 3 u of 16384 pixels are 3/1024. A rasteriser's
/// grid of 8 bits moves a corner by up to 1/256 more. Needs 0.6.
inline constexpr float kSubpixelSlack = 1.0f / 128;
/// Of the ellipse's area. cos²a - sin²t loses u / (cos²a - sin²t), which counts one and a half times; with up
/// to some 40 more roundings. Needs 0.9 where cos²a - sin²t > 1/4 and the sphere is not within a tenth of the
/// eye's distance from the origin; beyond that the area may come out too small by more.
inline constexpr float kAreaGrowth = 1e-5f;

// --- sectors, chunks ---

/// Of |low| + |high|, for half a box's size about its rounded centre: high - centre rounds once (u/2 of the
/// sum at most), and so do adding this bound and restoring centre + half (u each at most). Needs 0.3; 2 u
/// would do.
inline constexpr float kHalfSizeRounding = 4 * static_cast<float>(kUnit);
/// A sector's planes are moved outwards by 8 u of Σ (kPlaneRounding) and lose up to 5 u more where they are
/// evaluated: what lies farther out than both is surely outside by them. Needs 0.4.
inline constexpr double kSectorRounding = 32 * kUnit;
/// The same planes in double precision: an element of the product of two matrices is off by 4, the sum of two
/// rows by 1 more, its length and the division by 4, evaluating by 5 times 2^-53 of what the products' parts
/// add up to. Needs 0.04: far from tight, and far below kSectorRounding but for boxes at the world's end.
inline constexpr double kSectorDoubleRounding = 0x1p-46;

// --- points about the eye ---

/// A row of EyeProjection times q = (p - eye_high) - eye_low: q rounds twice, then as a plane: 7 u of Σ.
/// Needs 0.3 (7/16 at most).
inline constexpr float kRowRounding = 16 * static_cast<float>(kUnit);
/// Of 1 / (w - error): difference, quotient, and the product with 1 + this, 3 u. Needs 0.2.
inline constexpr float kReciprocalRounding = 1e-6f;

// --- outlines of occluders, in pixels ---

/// How far within its outline an occluder must hold a pixel centre, and how much more per pixel of the
/// outline's largest coordinate. x = (row·q)·(1/w) is off by 7 u of (Σ|x_i q_i| + |x|·Σ|w_i q_i|) / w + 2
/// u|x|. In a view of up to 1.2 radians Σ|x_i q_i| / w is at most some 3 image widths, and an edge adds 8 u
/// of its coordinates: (bx-ax)/(by-ay), ax - ay·slope and at + slope·y round six times. Needs 0.3 of ends
/// within two images around images of 8192 pixels; farther ends move along the edge more than across it, and
/// within the image it needs 0.08. Both sums are at most a row's length times the point's: what a telescope's
/// focal length of f pixels asks for, 7 u·f, is kCornerRounding of it, in place of kInset where that is less.
inline constexpr float kInset = 1.0f / 256, kInsetGrowth = 2e-6f;
/// Pixels per pixel of the focal length, and of a corner's own place: by so much rounding may move it. Which
/// way a triangle turns is sure where twice its area is more than that along its edges: over thousands of
/// pixels a triangle seen edge on has several pixels of area by rounding alone.
inline constexpr float kCornerRounding = 8 * static_cast<float>(kUnit);
/// An edge that rises by less is no side of the outline. Sure because it is less than kInset: the outline's
/// rows end that much inside, so none lies between such an edge's ends.
inline constexpr float kFlatEdge = 1e-3f;
static_assert(kFlatEdge < kInset);
/// The same of triangles asked for, which grow by a side less; not a bound.
inline constexpr float kAskedFlatEdge = 1.0f / 64;
/// Twice the area in pixels from which on a triangle, a clipped polygon, is worth drawing. Not a bound: where
/// rounding turns a thinner one over, its sides change places, and hold nothing between them.
inline constexpr float kLeastDrawnArea = 0.02f, kLeastClippedArea = 0.5f;
/// Pixels that a triangle asked for grows by besides what its own numbers ask for: a rasteriser's grid of 8
/// bits moves a corner by up to 1/256.
inline constexpr float kAskedSlack = 1.0f / 256;
/// Pixels: one that would have to grow by more, which is for a corner close to the eye, is clipped first.
inline constexpr float kMostSlack = 1.0f / 16;
/// Twice a triangle's area on the image rounds by 8 u of its width times its height: less than this share of
/// kInsetGrowth times its largest coordinate times the sum of both. Needs 0.3.
inline constexpr float kAreaRounding = 1.0f / 4;
/// Pixels from the image's corner: beyond, a triangle asked for is clipped first, as kInsetGrowth asks.
inline constexpr float kFarthestPlace = 30000;

// --- nearness of planes ---
// A plane's nearness at a pixel is at + x·across + y·down. An occluder's lies this much lower, that of a
// triangle asked for this much higher: kNearnessRounding of its nearest point, and kPixelPlay of |across| +
// |down|, and the normal's part.

/// 1/w rounds as kReciprocalRounding says, with w off by 7 u of Σ: some 20 u. Needs 0.1: what is left is
/// slack.
inline constexpr float kNearnessRounding = 2e-5f;
/// A rasteriser moves corners by up to 1/256 pixel, and with them the plane; and x·across, which is as large
/// as 8192·|across|, rounds up to ten times (coefficient, product, sums): 10 u·8192 = 1/205 of |across|.
/// Needs 0.3.
inline constexpr float kPixelPlay = 1.0f / 64;
/// The normal of a triangle whose corners are off by u of their largest coordinate, `reach`, turns by 2
/// u·reach over its height; both products of the cross product round, which makes up to 7 u of reach·sides /
/// |normal|; and that tells 1 / sin of the angle under which the plane is seen. For drawing and asking. Needs
/// 0.03 and 0.08: the errors of a corner's coordinates seldom add up, and move the plane at all the
/// triangle's pixels alike.
inline constexpr float kDrawnNormalRounding = 4.2e-7f, kAskedNormalRounding = 4e-7f;
/// For drawing that is told of rays and corners up to so many times as far away as they are deep. Of corners
/// farther to the side it is as many times more: the plane's distance, a corner's along the normal, is off by
/// 3 u of the corner's besides.
inline constexpr float kAside = 2;
/// Beyond, the plane of a triangle asked for says nothing, and its nearest point stands for it; not bounds.
inline constexpr float kMostDoubt = 1e4f, kMostNearness = 1e30f;
/// Corners of a polygon lie up to e from the plane that it is drawn on, d from the eye: its nearness there is
/// less by the part e / d at most, of a d that is off by a 40th where kEdgeOnPart just lets it pass. Needs
/// 0.82.
inline constexpr float kPolygonApart = 1.25f;
/// What is seen in the space before a placement rounds there: as much more counts here as the way there and
/// back adds up to. 3 at most of what is turned, and scaled along its own axes; 4 where turned things are
/// scaled to half along one axis: of that Σ kInset needs 0.08 within the image, 0.3 beside it. Outlines of
/// what is skewed more lie as many times farther within. Nothing is drawn that is skewed beyond the most: so
/// often 20 u of the nearness (kNearnessRounding) and 9 u before the near plane still are within their
/// bounds.
inline constexpr double kFreeSkew = 4, kMostSkew = 16;
/// Of |at|, when that plane is moved: the move rounds 1 u of it, and its terms next to nothing. Needs 0.48.
inline constexpr float kPolygonRounding = 1.25e-7f;
/// Of a tile's nearest value: what else its pixels' sums may round to. No promise hangs on it: where it is
/// too low, what is asked for is called visible.
inline constexpr float kTileRounding = 1e-6f;

/// A plane closer to the eye than `part` of the largest coordinate and `distance` metres, or in an
/// orthographic view one seen under a smaller angle than `sine`, is not drawn: its nearness is a quotient by
/// that distance. The distance is off by some 10 u of the coordinates where a triangle is no sliver: needs
/// 0.02 for the sign to be sure; the rest keeps the quotient's digits (kNearnessRounding).
/// The distances in metres are no bounds: they only keep the quotient finite where all coordinates are next
/// to 0.
inline constexpr double kEdgeOnSine = 1e-4, kEdgeOnPart = 1e-5, kEdgeOnDistance = 1e-6;
/// Of a triangle with sides of largest coordinates a and b from a corner on, and corners as far as r, the
/// product of the normal that they span with that corner rounds, with its terms, by 54 u·abr; and corners
/// about the eye, off by 2 u·r, turn it by up to 24 u·r²(a + b): of r·(2ab + r(a + b)). Against a direction
/// it is an r less. Needs 0.21.
inline constexpr float kSideRounding = 32 * static_cast<float>(kUnit);
/// The same for a box's faces, whose distance is a coordinate and off by 2 u of it: needs 0.01. Of boxes
/// nearer than that every face is clipped and drawn by itself, in double precision.
inline constexpr float kFacePart = 1e-5f, kFaceDistance = 1e-6f, kFaceSine = 1e-5f;

// --- the near plane ---

/// How far before it the prepared near plane lies, by the eye's distance from the plane and from the origin,
/// so that nothing is drawn that the plane cuts off: rounding its row and evaluating it about the eye loses
/// 9 u of what reaches about as far as the plane does, and double precision next to nothing of the eye. Needs
/// 0.08.
inline double near_plane_slack(double at_eye, double eye) noexcept {
  return 1e-5 * (std::fabs(at_eye) + 1e-3 * eye + 1e-3);
}
/// Of an orthographic image's size, the same: 9 u of half of it.
inline constexpr double kNearSideways = 1e-6;
/// In w, where a view has no front plane.
inline constexpr double kLeastW = 1e-6;
/// What a triangle asked for keeps before the near plane: twice what near_plane_slack() says now, which moved
/// it, a part of the plane's distance from the eye (needs 0.01), and of the corners' largest coordinate, for
/// 3 u of Σ that row and corners round by, and 2 u more of a row of the view (needs 0.15).
inline constexpr double kKeptBeforeNear = 1e-3, kKeptReach = 1e-6;

// --- boxes of groups of triangles ---

/// Rounding half a size to single precision takes u of it. A group left out by mistake would only hide less,
/// so no promise hangs on it.
inline constexpr double kGroupGrowth = 1e-6;

// --- spheres ---

/// As far as rows may be from a right angle for discs to be drawn; an ellipse sheared by s holds one with its
/// axes along the image's that is s/2 smaller, and scales and reciprocal round some 13 u. Needs 0.25 for the
/// shear.
inline constexpr double kMostShear = 1e-5, kDiscShrink = 2e-5;
/// Of the nearer disc's radius: 0.6² + 0.8² = 1, each factor rounded once, and 0.6·radius·axis twice more, of
/// which 3/4 counts. Needs 0.15.
inline constexpr float kDiscRounding = 1e-6f;
/// How far before the near plane a sphere must lie, of its radius and of the sum of its centre's coordinates:
/// the normal's length is off by u, and evaluating the plane loses 5 u. Needs 0.25 of the second, 0.0005 of
/// the first, which is slack.
inline constexpr float kSphereClearance = 1e-4f, kSphereReach = 1e-6f;
/// Of the radius and of that sum: moving the centre about the eye takes 2 u of it, a row 5 u more. Needs
/// 0.25.
inline constexpr float kSphereGrowth = 1e-6f;
/// Pixels, and of the rectangle's largest coordinate. The roots' numerator and denominator are differences
/// that lose up to 1 / kLeastClearance of their digits where the sphere comes that close to the eye's plane,
/// of its distance; closer ones are called visible. 1/256 is a rasteriser's grid. Needs 0.2 (of the growth
/// alone 0.02), where the sphere does not grow by kSphereGrowth what it would lose.
inline constexpr float kSphereSlack = 1.0f / 64, kSphereSlackGrowth = 2e-5f, kLeastClearance = 1e-2f;

}  // namespace sightline::geometry
