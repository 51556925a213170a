// How right any method could be that knows of a fragment only where it is in its crown and how it faces: what is left
// of the truth when the best smooth function of those is taken out. Leaves lie at random, so that fragments of one
// depth and facing see different shares of the sky; that scatter no mean can follow.
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace understory {

/// Values whose mean square error is that of the best smooth function of `place` (any unit, alike in both): at each
/// point a plane is fitted to the 32 nearest others, and its residual is reduced by what the plane's own uncertainty
/// adds (leave-one-out variance over 1 + leverage: unbiased where the function is a plane over the neighbourhood). One
/// truth value a place, else Error(unexpected); fewer than 33 places: the truth itself.
std::vector<float> best_of_place(std::span<const glm::dvec2> places, std::span<const float> truth);

}  // namespace understory
