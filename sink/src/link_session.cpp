/* HELLO, UPLINK, ANSWER. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/link_session.h"

#include "tsr/host/sink_answer.h"

extern "C" {
#include "tsr/base/bytes.h"
}

namespace tsr
{

void LinkServer::send(LinkSession &session, std::span<const std::uint8_t> frame)
{
    counts_.bytes_out += frame.size();
    session.outgoing_.insert(session.outgoing_.end(), frame.begin(), frame.end());
}

void LinkServer::hello(LinkSession &session, const tsr_link_frame &frame)
{
    tsr_reader reader = tsr_reader_make(frame.body, frame.body_len);
    const std::uint8_t version = tsr_read_u8(&reader);
    const std::uint16_t pan_id = tsr_read_u16(&reader);
    const std::uint16_t gateway = tsr_read_u16(&reader);
    counts_.hellos++;
    session.refused_ = frame.body_len != TSR_LINK_HELLO_LEN || version != TSR_LINK_VERSION || pan_id != pan_id_;
    if (session.refused_) {
        receiver_.tally().add(Cause::hello_refused);
        return;
    }
    auto &last = last_answers_[gateway];
    if (!last) {
        last = session.last_;
    }
    session.last_ = last;
}

void LinkServer::take_frame(LinkSession &session, const tsr_link_frame &frame, std::vector<Request> &requests)
{
    if (frame.type == TSR_LINK_HELLO) {
        answer_all(requests); /* keeps the order of answers */
        hello(session, frame);
        send(session, answer_frame(frame.sequence, {}));
    } else if (frame.type == TSR_LINK_UPLINK && session.refused_) {
        answer_all(requests);
        receiver_.tally().add(Cause::hello_refused);
        send(session, answer_frame(frame.sequence, {}));
    } else if (frame.type == TSR_LINK_UPLINK) {
        counts_.uplinks++;
        requests.push_back({&session, frame.sequence, {frame.body, frame.body + frame.body_len}});
    } else {
        receiver_.tally().add(Cause::link_unexpected);
    }
}

void LinkServer::process(std::span<const Input> inputs)
{
    std::vector<Request> requests;
    for (const Input &input : inputs) {
        counts_.bytes_in += input.bytes.size();
        for (const std::uint8_t byte : input.bytes) {
            tsr_link_frame frame{};
            const tsr_status status = tsr_link_decode(&input.session->decoder_, byte, &frame);
            if (status == TSR_OK) {
                take_frame(*input.session, frame, requests);
            } else if (status != TSR_AGAIN) {
                receiver_.tally().add(Cause::link_damaged);
            }
        }
    }
    answer_all(requests);
}

void LinkServer::answer_all(std::vector<Request> &requests)
{
    /* A gateway keeps one frame unanswered, so a repetition meets its original in an
     * earlier batch; two in one batch are only answered alike by the receiver. */
    std::vector<std::vector<std::uint8_t>> fragments;
    std::vector<bool> repeated;
    for (const Request &request : requests) {
        const LinkSession::LastAnswer &last = *request.session->last_;
        repeated.push_back(!last.uplink.empty() && last.sequence == request.sequence && last.uplink == request.body);
        if (!repeated.back()) {
            const std::size_t header_len = std::min<std::size_t>(TSR_LINK_UPLINK_HEADER_LEN, request.body.size());
            fragments.emplace_back(request.body.begin() + static_cast<std::ptrdiff_t>(header_len), request.body.end());
        }
    }
    const std::vector<std::vector<std::uint8_t>> answers = receiver_.receive(fragments);
    std::size_t next = 0;
    for (std::size_t i = 0; i < requests.size(); i++) {
        Request &request = requests[i];
        LinkSession::LastAnswer &last = *request.session->last_;
        if (repeated[i]) {
            counts_.repeated_uplinks++;
        } else {
            last = {request.sequence, std::move(request.body), answer_frame(request.sequence, answers[next++])};
        }
        send(*request.session, last.answer);
    }
    requests.clear();
}

} // namespace tsr
