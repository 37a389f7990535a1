// Where reading a scene says what is wrong.
#include "scene/complaints.h"

#include <fmt/format.h>

#include <utility>

namespace lobe::scene {
namespace {

constexpr std::size_t most = 100;

}  // namespace

void Complaints::error(Pointer pointer, std::string message, std::string help)
{
    ++errors_;
    if (kept_errors_ == most) return;
    ++kept_errors_;
    all_.push_back({true, std::move(pointer), std::move(message), std::move(help)});
}

void Complaints::note(Pointer pointer, std::string message, std::string help)
{
    ++notes_;
    if (kept_notes_ == most) return;
    ++kept_notes_;
    all_.push_back({false, std::move(pointer), std::move(message), std::move(help)});
}

std::vector<Complaint> Complaints::take()
{
    const std::size_t room_for_notes = most - kept_errors_;
    std::vector<Complaint> told;
    std::size_t told_notes = 0;
    for (Complaint& complaint : all_) {
        if (!complaint.is_error && told_notes++ >= room_for_notes) continue;
        told.push_back(std::move(complaint));
    }
    const std::size_t all = errors_ + notes_;
    if (all > told.size())
        told.push_back({errors_ > kept_errors_, "", fmt::format("{} more", all - told.size()), ""});
    return told;
}

}  // namespace lobe::scene
