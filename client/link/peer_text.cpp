#include "link/peer_text.h"

#include "core/control_characters.h"

namespace haustra::link {

std::string peerText(const std::string& said, std::size_t mostBytes, bool keepLines) {
    std::string text;
    for (std::size_t at = 0; at < said.size();) {
        const auto [code, length] = characterAt(said, at);
        if (length == 0) break;
        if (at + length > mostBytes) return text + "…";
        if (isControlCharacter(code) && !(keepLines && (code == '\n' || code == '\t')))
            text += ' ';
        else
            text.append(said, at, length);
        at += length;
    }
    return text;
}

}  // namespace haustra::link
