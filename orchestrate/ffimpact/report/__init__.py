"""What finished runs are told and shown in: key figures, pictures, films, the page beside the
paper.
"""
