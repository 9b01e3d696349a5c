// How far to smooth along an edge, where across it little can be.
#pragma once

#include "photon/bandwidth.h"

namespace lsde {

// The disc, or an ellipse of the same width along which light is as even as over a disc's radii: twice as long, or up
// to four times. Its direction is that in which power is spread most widely about its centroid in a larger disc. It
// grows as long as the estimate is consistent with those of all shorter ones, what it takes in has the power of what it
// had, and no more photons of denser blocks: the tests of the disc (consistentBandwidth). On a bent edge its ends would
// leave the light, so they end it. scratch.surface is about the photon; scratch.density.accepted afterwards holds what
// lies within, and some more.
// Not on bent surfaces, and not for dispersed light: each channel is a part of it, whose tests are weaker (a lens's
// coloured rim was off by .8%).
Bandwidth elongated(const PhotonSource& source, uint32_t photon, const Bandwidth& disc, const BandwidthRule& rule,
                    BandwidthScratch& scratch);

}  // namespace lsde
