// Where reading a scene says what is wrong: in the order in which it is found, the first hundred.
#pragma once

#include "scene/gltf.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lobe::scene {

class Complaints {
public:
    void error(Pointer pointer, std::string message, std::string help = {});
    void note(Pointer pointer, std::string message, std::string help = {});

    bool has_errors() const { return errors_ > 0; }
    /// What was said, errors before notes where there is not room for both, and how much was left
    /// out.
    std::vector<Complaint> take();

private:
    std::vector<Complaint> all_;
    std::size_t errors_ = 0;
    std::size_t notes_ = 0;
    std::size_t kept_errors_ = 0;
    std::size_t kept_notes_ = 0;
};

}  // namespace lobe::scene
