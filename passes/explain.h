// What a scene can show, told in words: its lights, what bends their light, where that falls; and if there is no
// caustic, why.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/run.h"
#include "photon/ledger.h"
#include "scene/scene.h"

namespace lsde {

// Why no light arrives by LS+D.
enum class NoCaustics : uint8_t {
    ThereAre,
    NoLight,          // none takes part
    NothingSpecular,  // no mirror, no glass, nothing smooth
    TooRough,         // what is specular scatters widely: its light counts as diffuse
    FacesAway,        // no light shines towards what is specular: behind a lamp, past a spot
    NotReached,       // something is in the way
    LandsNowhere,     // what comes off is absorbed or leaves the scene
    ReceivesNot,      // extras.lsde.receivesCaustics is false where it lands
};
std::string_view name(NoCaustics reason);  // "thereAre", "noLight", ...

struct Explanation {
    NoCaustics reason = NoCaustics::ThereAre;
    std::string noCaustics;                               // "no caustics here: ..."; empty if there are
    std::string text;                                     // one paragraph, noCaustics included
    std::vector<std::string> lights, casters, receivers;  // names; receivers: those that caustics fall on
    Rgb emitted{0}, caustic{0};                           // W; by LS+D, on what receives them

    nlohmann::json json() const;
};

// From the ledger of `paths` light paths of the selected lights, aimed or not.
Explanation explain(const Scene& scene, const std::vector<bool>& lights, const Ledger& ledger, uint64_t paths);

// The same by a small emission of its own, for all lights: hundredths of a second.
Explanation explainByPilot(const Scene& scene, RunContext& run);

}  // namespace lsde
