#pragma once

#include <string>

namespace semantic_mht_slam {

/// Text as it stands in the content or in an attribute of an XML, SVG or HTML element: markup characters become
/// entities, control characters, which have no place in XML, blanks.
std::string escapedMarkup(const std::string& text);

}  // namespace semantic_mht_slam
